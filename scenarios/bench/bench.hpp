#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/stereo_frame.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace understory {

/// What one algorithm costs for one pair, over all pairs and rounds.
struct BenchRow {
  std::string name;
  int threads = 1;
  double median_ms = 0;
  double p90_ms = 0;
  double p99_ms = 0;
  std::string yardstick;  ///< name of the row it is measured against; empty for a yardstick itself
  double ratio = 0;       ///< median over the yardstick's; 0 for a yardstick
  double p99_ratio = 0;   ///< of a planner: p99 over the yardstick's median
};

/// One flight of the program, from its process's start to its end.
struct TimedFlight {
  double simulated_s = 0;
  double wall_s = 0;                           ///< the process's own, loading of libraries included
  double frames = 0;                           ///< stereo pairs
  std::map<std::string, double> stage_s = {};  ///< wall time per stage of the loop (FlightResult's timings)
  double peak_memory_mb = 0;                   ///< maximum resident set
  double cpu_s = 0;                            ///< the process's own
};

/// What flights of one kind cost.
struct ClosedLoopRow {
  std::string name;
  int processes = 1;  ///< side by side
  int flights = 0;
  double pairs_per_s = 0;          ///< stereo pairs, of all processes together, per second
  double cpu_per_simulated_s = 0;  ///< seconds of a core per simulated second: other load hardly changes it
  double simulated_per_s = 0;  ///< simulated seconds, of all processes together, per second: real time is 1
  /// Of the flights' own wall time, by stage and "other"; they add up to 1.
  std::vector<std::pair<std::string, double>> shares;
  double peak_memory_mb = 0;  ///< of the flight that needs most
  std::string yardstick;      ///< name of the row it is measured against; empty for a yardstick itself
  double ratio = 0;           ///< elapsed time per simulated second over the yardstick's; 0 for a yardstick
  double render_ms = 0;       ///< mean wall time of rendering a stereo pair
};

/// `elapsed_s`: from the first flight's start to the last one's end. `yardstick`: nullptr, or the row to
/// measure against.
ClosedLoopRow closed_loop_row(const std::string& name, int processes, const std::vector<TimedFlight>& flights,
                              double elapsed_s, const ClosedLoopRow* yardstick);

/// The figures of a flight's result.json. Throws MachineError if it cannot be read.
TimedFlight timed_flight(const std::filesystem::path& result_file);

/// A table for a person, and the same as a JSON list of rows.
std::string to_table(const std::vector<BenchRow>& rows);
std::string to_json(const std::vector<BenchRow>& rows);
std::string to_table(const std::vector<ClosedLoopRow>& rows);
std::string to_json(const std::vector<ClosedLoopRow>& rows);

/// Times OpenCV's remap, StereoBM and StereoSGBM and the detector's variants on `frames` (as the rig delivers
/// them: raw where it has raw cameras), all in one run, taking turns round by round, so that other load
/// affects all alike. In its turn each goes over all pairs a few times, the first untimed: a pair is used
/// again after all others, so it comes from the outer caches. Slow yardsticks skip most `rounds`. OpenCV runs
/// on one thread.
std::vector<BenchRow> bench_detectors(const CalibratedRig& rig, const std::vector<StereoFrame>& frames,
                                      int rounds, const std::function<void(int round)>& on_round);

/// What a scenario's planner was asked in real flights: the text of a file of scenarios/library/problems, as
/// tests/bench/recorded_planner.cpp writes it.
struct PlannerProblems {
  Scenario scenario;
  std::string name;  ///< of the file, for messages
  std::string text;
};

/// Times replans, each problem's by its median over the rounds, so that p99 is that of problems and not of
/// other load, and StereoBM on `rectified` in between. A flight's problems go to one planner in their order,
/// since it keeps its plan. Throws ScenarioError "name:line: ..." where a text is none.
std::vector<BenchRow> bench_planner(const std::vector<PlannerProblems>& all,
                                    const std::vector<StereoFrame>& rectified, int rounds,
                                    const std::function<void(int round)>& on_round);

struct ClosedLoopBenchOptions {
  /// Each is flown alone, then two side by side; the first also with ten times the trees, spread wider.
  std::vector<std::filesystem::path> scenarios;
  std::uint64_t first_seed = 1000, last_seed = 1003;
  std::vector<std::string> arguments;  ///< of every flight: --set, --renderer
  std::function<void(const std::string& what)> on_progress = [](const std::string&) {};
};

/// Times whole flights, a process each, in wall time: only rows of one run on an idle machine can be
/// compared. A flight with ten times the trees is as long and as dense as its yardstick: the forest reaches
/// 200 m to either side instead of 20. Throws ScenarioError if a flight refuses its input, MachineError if
/// one fails.
std::vector<ClosedLoopRow> bench_closed_loop(const ClosedLoopBenchOptions& options);

/// Pairs as a flight through a forest gives them, rendered by ray casting without any simulator: trunks from
/// 2 to 40 m, ground, sky, bark and soil textured at every scale that a pixel can show, the camera rolled as
/// in a dodge, sensor noise of two gray levels. No two are alike. With raw cameras in `rig` the pairs come
/// raw, else rectified.
std::vector<StereoFrame> stereo_scenes(const CalibratedRig& rig, int count, std::uint64_t seed);

}  // namespace understory
