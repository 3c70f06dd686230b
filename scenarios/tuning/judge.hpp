#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/tuning/objective.hpp"

namespace understory {

struct Scenario;

/// What is counted on one unit of data (a flight, a recording), in the judge's own order. Counts of several
/// units together say what the configuration is on all of them.
using Counts = std::vector<double>;

struct Measured {
  std::vector<Counts> units = {};  ///< in the data's order, the same units for every scenario
  std::string refused = {};        ///< why nothing was measured, one line; empty where it was
};

/// How much of the data is looked at. A glance at a part of each unit costs an eighth of the whole.
enum class Look { glance, whole };

/// Measures scenarios on some data. The same scenario always gives the same result.
class Judge {
 public:
  virtual ~Judge() = default;
  /// `name`: letters, digits and '-', unique to this scenario. Throws Stopped, and MachineError where the
  /// machine fails.
  virtual Measured measure(const std::string& name, const Scenario& scenario, Look look = Look::whole) = 0;
  /// The figures of some units (one or more, some perhaps twice) together, in the order of their names.
  virtual Figures figures(std::span<const Counts> units) const = 0;
};

struct FlightJudgeConfig {
  std::filesystem::path folder;      ///< keeps each flight's file: what is flown is not flown again
  std::vector<std::uint64_t> seeds;  ///< one or more
  std::string renderer = "osmesa";
  double timeout_s = 300;  ///< of wall time: a flight that takes longer hangs
  int jobs = 1;            ///< flights at a time, each a process
};

/// success: share of flights at the goal; progress: how far they came, of the way to the goal, mean;
/// mean_speed_mps; position_error_m.
extern const std::vector<std::string> flight_figure_names;

/// Flies a scenario with every seed. Counts of a flight: at the goal (0 or 1), then the other figures. A
/// scenario is refused if one of its flights failed to run; a flight that somebody killed is the machine's
/// failure.
std::unique_ptr<Judge> flight_judge(FlightJudgeConfig config);

/// Shares at one pixel: docs/tuning.md says what each is.
extern const std::vector<std::string> vision_figure_names;

/// Whether the hits of the scenario's detector on recordings can depend on a key of it.
bool matters_on_recordings(const Scenario& scenario, std::string_view key);

/// Runs a scenario's detector over every `every`-th frame of recordings, which it holds in memory (0.55 MB a
/// frame), `threads` recordings at a time; the result does not depend on that. Figures are those of
/// `understory evaluate`: full stereo is compared at the pushbroom's depth alone. A glance is a stretch of
/// each recording, at another place in each. A scenario whose depths the rig cannot show is refused. Throws
/// ScenarioError where a folder cannot be read, has no true depth, or another rig than the first.
std::unique_ptr<Judge> vision_judge(const std::vector<std::filesystem::path>& folders, int every,
                                    int threads);

}  // namespace understory
