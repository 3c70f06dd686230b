#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/campaign/campaign_file.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "scenarios/tuning/search.hpp"

namespace understory {

/// One number of a scenario, with the bounds that its key has.
struct NumericKey {
  std::string key;     ///< "perception.pushbroom.score_limit"; an entry of a list: "... .depths_m[0]"
  bool whole = false;  ///< a whole number
  double minimum = 0, maximum = 0;
  double value = 0;  ///< in this scenario
};

/// Every number of a scenario in the order of its keys, except seeds, which are not to be tuned. Of a list,
/// the entries that the scenario has.
std::vector<NumericKey> numeric_keys(const Scenario& scenario);

enum class TuningData { recordings, flights };

/// What is tuned, for what, over which data.
struct TuneFile {
  std::string name;
  std::string text;  ///< as written
  std::filesystem::path scenario_file;
  Scenario scenario;  ///< as it is without tuning
  Space space;
  Point scenario_point;  ///< the parameters' values in `scenario`
  Objective objective;
  std::vector<std::string> figures;  ///< names, in their order
  SearchConfig search;
  TuningData over = TuningData::recordings;
  std::vector<std::filesystem::path> training_folders, validation_folders;  ///< over recordings
  int every = 1;  ///< over recordings: every n-th frame is used, in training and validation
  std::vector<std::uint64_t> training_seeds, validation_seeds;  ///< over flights
  std::vector<std::uint64_t> fly;  ///< over recordings: seeds that the best few fly in the end; none: none
  double timeout_s = 300;          ///< of a flight, wall time
};

/// Reads a file:
///
///     scenario: forest                 # of the library, or a file beside this one
///     parameters:                      # any numeric keys of the scenario
///       perception.pushbroom.minimum_edge_sum: {from: 100, to: 900}
///       perception.pushbroom.score_limit: {from: 0.05, to: 0.4, scale: log}
///       perception.pushbroom.uniqueness_ratio: {values: [1.5, 2, 3]}
///     objective: {maximize: recall, at_least: {precision: 0.97}}   # minimize, at_most; lists of goals
///     search: {method: cma_es, trials: 2000, seed: 1}     # a grid: steps of each range, no trials
///                                      # sensitivity: 9, points of each parameter varied alone afterwards
///     over: recordings                 # or flights
///     training: [folder, folder]       # over flights: seeds, 1000..1019
///     validation: [folder]             # none of them in training
///     every: 1                         # optional, over recordings: look at one of so many frames
///     fly: 1100..1119                  # optional, over recordings: seeds that the best few fly in the end
///     timeout_s: 300                   # optional, of a flight
///     name: forest                     # optional; otherwise the file's
///
/// Throws ScenarioError in one line, "file:line: key: expected ...": an unknown key, a parameter that is no
/// number of the scenario or goes beyond its bounds, an unknown figure, data in both training and validation,
/// any error of the scenario.
TuneFile load_tune_file(const std::filesystem::path& file, const FindScenario& find_scenario);

}  // namespace understory
