#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/config/config_tree.hpp"

namespace understory {

/// Finds the file that a scenario's name means, as on the command line.
using FindScenario = std::function<std::filesystem::path(const std::string&)>;

/// Reads a campaign file:
///
///     scenarios: [forest, dense]        # or scenario: forest; of the library, or files beside this one
///     seeds: 1..200                     # or a list: [1, 7, 1000..1019]
///     overrides:                        # optional, each flown on its own
///       - {name: ours}
///       - {name: blind, set: {perception.detector: none}}
///       - {name: tuned, with: best.yaml}  # files of keys, beside this one or where they are said to be
///     grid:                             # optional: every combination, over each override
///       autopilot.flight_model.cruise_speed_mps: [10, 12]
///     timeout_s: 300                    # optional, 1 .. 86400
///     seeds_apart: 1000                 # optional: the second scenario flies the seeds and 1000 more, ...
///     name: speed                       # optional; otherwise the file's
///
/// `over` changes keys of every condition but not its name, so that the gate can compare campaigns that
/// differ in it alone. `on_condition` is called for each condition read. Throws ScenarioError in one line,
/// "file:line: key: expected ...": an unknown key, no seeds, a seed or a condition twice, or any error of a
/// scenario.
Campaign load_campaign(const std::filesystem::path& file, const FindScenario& find_scenario,
                       const std::vector<ConfigNode>& over = {},
                       const std::function<void(std::size_t done, std::size_t of)>& on_condition = {});

/// "1..200", "7" or several of these, as seeds. Throws ScenarioError, beginning with `where`, for other words
/// and a seed that is given twice.
std::vector<std::uint64_t> seeds_of(const std::vector<std::string>& ranges, const std::string& where);

/// The scenario that `word`, given under a key of `top`, means: a file beside `file`, or the file that the
/// command line would find. Throws ScenarioError, beginning with the key and its line.
std::filesystem::path scenario_beside(const std::filesystem::path& file, const ConfigNode& top,
                                      const std::string& key, const std::string& word,
                                      const FindScenario& find_scenario);

/// `name` if `top` has the key "name", else the file's name without its ending. Throws ScenarioError if
/// `name` is not a plain name.
std::string name_or_stem(const std::string& name, const ConfigNode& top, const std::filesystem::path& file);

/// The seeds under a key of `top`: "1..200", "7", or a list of such things. Throws ScenarioError where there
/// are none or one is given twice.
std::vector<std::uint64_t> seeds_in(const std::vector<std::string>& words, const ConfigNode& top,
                                    const std::string& key);

}  // namespace understory
