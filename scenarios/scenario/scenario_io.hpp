#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/scene/trees.hpp"

namespace understory {

struct Key;

/// Reads a scenario: defaults, then the presets, then the file's keys, then those of each file of `with` in
/// turn, then each "key=value" of `settings` in turn. So a preset never overwrites a key that is given.
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

/// The file that forest.trees_file names: beside the file that gives the key (`origin`: "file:line"; empty:
/// none), from the working directory, or in the folder that UNDERSTORY_DATA names; the name as it is if there
/// is no such file.
std::string found_trees_file(const std::string& trees_file, const std::string& origin);

/// Every key of a scenario with its value.
std::vector<Key> keys_of(Scenario scenario);

/// The effective scenario, every default written, as YAML that reads back to the same scenario.
std::string scenario_to_text(const Scenario& scenario);

/// The obstacles of the scenario's course and seed; of a forest with scenery `woods` also its trees.
Wood course_wood(const Scenario& scenario);
/// The look of a scenario's woods: what its keys leave open is drawn from its seed.
WoodsConfig woods_of(const Scenario& scenario);
std::vector<Obstacle> course_obstacles(const Scenario& scenario);
/// For pictures: the crown of each tree of woods, from its lowest branch to its top, with the reach of its
/// longest branch. Empty in plain scenery, and if the file of a measured forest is no longer there.
std::vector<Obstacle> course_crowns(const Scenario& scenario);

/// The part of a scenario that concerns vision, for commands that look at recordings: the detectors' and the
/// map's numbers under a scenario's own keys (perception.preset, perception.depths_m, perception.pushbroom.X,
/// ..., autopilot.map.X), so that a file of keys means the same in `fly`, `detect` and `evaluate`.
struct VisionConfig : PerceptionSection {
  LocalMapConfig map;
};

/// Where its keys come from.
struct VisionConfigSources {
  PushbroomPreset preset = PushbroomPreset::tuned;  ///< where no key names one
  std::vector<std::string> with = {};               ///< files of keys
  std::vector<std::string> settings = {};           ///< key=value, over the files
  bool one_depth = false;  ///< the rig's detection depth alone, where no key names depths
};

/// The preset's numbers for a rig of this name, overridden by the keys. Throws ScenarioError, one line that
/// names file and line or the setting.
VisionConfig read_vision_config(const VisionConfigSources& sources, std::string_view rig);

/// The rig that a recording was made with, as its scenario.yaml names it; empty if another program recorded
/// it. Throws ScenarioError if that file cannot be read.
std::string rig_named_in(const std::filesystem::path& recording);

}  // namespace understory
