#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/scenario/scenario.hpp"

namespace understory {

/// What a scenario says of seeing, for commands that look at recordings: the detectors' and the map's numbers
/// under a scenario's own keys (perception.rule, perception.depths_m, perception.pushbroom.X, ...,
/// autopilot.map.X), so that a file of keys means the same in `fly`, `detect` and `evaluate`.
struct VisionConfig {
  RulePreset rule = RulePreset::tuned;
  PushbroomConfig pushbroom;
  StereoBmConfig stereo_bm;
  StereoSgbmConfig stereo_sgbm;
  ComputeConfig compute;
  LocalMapConfig map;
};

/// Where its keys come from.
struct VisionConfigSources {
  RulePreset rule = RulePreset::tuned;     ///< where no key names one
  std::vector<std::string> with = {};      ///< files of keys
  std::vector<std::string> settings = {};  ///< key=value, over the files
};

/// The keys over the numbers that their rule has for a rig of this name, whose rectified images have so many
/// rows. Throws ScenarioError, one line that names file and line or the setting.
VisionConfig read_vision_config(const VisionConfigSources& sources, std::string_view rig,
                                int height_px = 240);

/// The rig that a recording was made with, as its scenario.yaml names it; empty where others recorded. Throws
/// ScenarioError where that file cannot be read.
std::string rig_named_in(const std::filesystem::path& recording);

}  // namespace understory
