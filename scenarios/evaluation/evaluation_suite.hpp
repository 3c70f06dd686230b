#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/campaign/campaign_file.hpp"

namespace understory {

/// A recording that a suite asks for, in the words of `understory record`.
struct SuiteRecording {
  std::string name;  ///< of its folder: the entry's name and the seed, "level-7"
  std::filesystem::path scenario;
  std::vector<std::string> settings;   ///< of --set, the seed among them
  std::vector<std::string> arguments;  ///< further ones: --path, --walk, --height
};

/// What `understory evaluate FILE` records before it evaluates.
struct EvaluationSuite {
  std::string name;
  std::vector<SuiteRecording> recordings;
};

/// Reads a suite:
///
///     recordings:
///       - {name: level, scenario: forest, seeds: 1..5, path: ../paths/level.tum, set: {world.bark_contrast:
///       0.2}}
///       - {name: walk, scenario: paper, seeds: 1..2, walk_mps: 1.4, height_m: 1.7}
///       - {name: flight, scenario: forest, seeds: 1..3}
///     set: {cameras.light: 0.5}     # optional: of all
///
/// Scenarios and paths are files beside the suite's, or, for scenarios, names of the library. Throws
/// ScenarioError "file:line: key: expected ...".
EvaluationSuite load_evaluation_suite(const std::filesystem::path& file, const FindScenario& find_scenario);

}  // namespace understory
