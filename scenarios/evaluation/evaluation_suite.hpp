#pragma once

#include <filesystem>
#include <vector>

#include "scenarios/campaign/campaign_file.hpp"

namespace understory {

/// Makes the recordings of a suite's file, `jobs` at once, each with `understory record` into
/// FOLDER/NAME-SEED; recordings that exist already are kept. Returns the recordings' folders, in the file's
/// order. The file:
///
///  recordings:
///  - {name: level, scenario: forest, seeds: 1..5, path: ../paths/level.tum, set: {world.bark_contrast: 0.2}}
///  - {name: walk, scenario: paper, seeds: 1..2, walk_mps: 1.4, height_m: 1.7}
///  - {name: flight, scenario: forest, seeds: 1..3}
///  set: {cameras.light: 0.5}     # optional: for all recordings
///
/// Scenarios and paths are files beside the suite's, or, for scenarios, what `find_scenario` finds. Throws
/// ScenarioError "file:line: key: expected ..." where the file or one of its scenarios is wrong, before
/// anything is recorded, and where one could not be recorded. `models`: the folder of that name.
std::vector<std::filesystem::path> record_suite(const std::filesystem::path& file,
                                                const std::filesystem::path& folder, int jobs,
                                                const FindScenario& find_scenario,
                                                const std::filesystem::path& models);

}  // namespace understory
