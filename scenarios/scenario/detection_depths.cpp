#include "scenarios/scenario/detection_depths.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "perception/io/rig_limits.hpp"
#include "scenarios/config/config_tree.hpp"

namespace understory {

void check_depths(const PushbroomConfig& rule, const StereoRig& rig, const std::string& depths_key,
                  const std::string& section) {
  const std::size_t depths = std::max<std::size_t>(1, rule.depths_m.size());
  for (const auto* thresholds : {&rule.depths_minimum_edge_sum, &rule.depths_score_limit})
    if (!thresholds->empty() && thresholds->size() != depths)
      throw ScenarioError(fmt::format("{}: expected thresholds for each of {} depths or none, got {}",
                                      section, depths, thresholds->size()));
  for (const double depth_m : rule.depths_m) {
    StereoRig asked = rig;
    asked.detection_depth_m = depth_m;
    if (!rig_limits::detection_depth_in_view(asked))
      throw ScenarioError(
          fmt::format("{}: expected depths the rig {} can look at, got {} m", depths_key, rig.name, depth_m));
  }
}

}  // namespace understory
