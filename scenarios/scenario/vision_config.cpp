#include "scenarios/scenario/vision_config.hpp"

#include <algorithm>

#include "scenarios/config/config_reader.hpp"

namespace understory {

/// The groups of a scenario that the keys stand in.
struct PerceptionKeys {
  VisionConfig& config;
};
struct AutopilotKeys {
  VisionConfig& config;
};
template <typename Visitor>
void visit_fields(Visitor& visit, PerceptionKeys& perception) {
  visit("rule", perception.config.rule, rule_names);
  visit("depths_m", perception.config.pushbroom.depths_m, 0.1, 1000.0);
  visit("pushbroom", perception.config.pushbroom);
  visit("stereo_bm", perception.config.stereo_bm);
  visit("stereo_sgbm", perception.config.stereo_sgbm);
  visit("compute", perception.config.compute);
}
template <typename Visitor>
void visit_fields(Visitor& visit, AutopilotKeys& autopilot) {
  visit("map", autopilot.config.map);
}
template <typename Visitor>
void visit_fields(Visitor& visit, VisionConfig& config) {
  PerceptionKeys perception{config};
  AutopilotKeys autopilot{config};
  visit("perception", perception);
  visit("autopilot", autopilot);
}

VisionConfig read_vision_config(const VisionConfigSources& sources, std::string_view rig, int height_px) {
  std::vector<ConfigNode> trees;
  for (const std::string& file : sources.with) trees.push_back(parse_config_file(file));
  for (const std::string& setting : sources.settings) trees.push_back(parse_assignment(setting));
  VisionConfig first;  // says which rule the others go over
  first.rule = sources.rule;
  for (const ConfigNode& tree : trees) read_config(tree, first);
  VisionConfig config;
  config.pushbroom = rule_of(first.rule, rig);
  config.pushbroom.last_row_px = last_row_px_of(height_px);
  for (const ConfigNode& tree : trees) read_config(tree, config);
  config.rule = first.rule;
  return config;
}

std::string rig_named_in(const std::filesystem::path& recording) {
  const std::filesystem::path file = recording / "scenario.yaml";
  if (!std::filesystem::exists(file)) return "";
  const ConfigNode scenario = parse_config_file(file);
  const auto rig = std::ranges::find(scenario.children, "rig", &ConfigNode::key);
  return rig == scenario.children.end() ? "" : rig->text;
}

}  // namespace understory
