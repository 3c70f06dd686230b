#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace understory {

/// Reads a scenario: defaults, then the presets, then the file's keys, then those of each file of `with` in
/// turn, then each "key=value" of `settings` in turn. So a preset never overwrites a key somebody wrote.
/// Throws ScenarioError in one line "file:line: key: expected ...": missing file, broken YAML, unknown or
/// doubled key, wrong type, out of range, or values that contradict each other.
Scenario load_scenario(const std::filesystem::path& file, const std::vector<std::string>& settings = {},
                       const std::vector<std::filesystem::path>& with = {});

/// The same with trees of keys instead of settings; messages name their origins.
Scenario load_changed_scenario(const std::filesystem::path& file, const std::vector<ConfigNode>& changes);

/// The same from text; `name` stands for the file in messages.
Scenario scenario_from_text(const std::string& text, const std::string& name,
                            const std::vector<std::string>& settings = {});

/// "file:line" or "--set ..." where a key was given; the file for a key at its default.
std::string where_given(const std::filesystem::path& file, const std::vector<std::string>& settings,
                        std::string_view key, const std::vector<std::filesystem::path>& with = {});

/// The effective scenario, every default written, as YAML that reads back to the same scenario.
std::string scenario_to_text(const Scenario& scenario);

/// The obstacles of the scenario's course and seed.
std::vector<Obstacle> course_obstacles(const Scenario& scenario);

}  // namespace understory
