#include "scenarios/parts/parts.hpp"

#include "estimation/filter.hpp"
#include "perception/full_stereo/full_stereo.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "perception/rectification/rectify.hpp"
#include "planning/planners/planners.hpp"
#include "scenarios/parts/oracles.hpp"

namespace understory {
namespace {

std::unique_ptr<ObstacleDetector> pushbroom_of(const PushbroomConfig& rule, const DetectorContext& context) {
  return std::make_unique<PushbroomStereo>(context.rig, rule);
}

template <typename MatcherConfig>
std::unique_ptr<ObstacleDetector> full_stereo_of(const MatcherConfig& matcher, const DetectorContext& context) {
  auto detector = std::make_unique<FullStereoDetector>(context.rig.rig, matcher, context.full_stereo);
  if (!context.rig.calibration) return detector;
  return std::make_unique<RectifyingDetector>(*context.rig.calibration, std::move(detector));
}

Parts make_built_in_parts() {
  Parts parts;
  parts.detectors.add("pushbroom", pushbroom_of, tuned_rule("long"));
  parts.detectors.add<StereoBmConfig>("stereo_bm", full_stereo_of<StereoBmConfig>);
  parts.detectors.add<StereoSgbmConfig>("stereo_sgbm", full_stereo_of<StereoSgbmConfig>);
  parts.detectors
      .add("true_depth",
           [](const DetectorContext& context) {
             return std::make_unique<TrueDepth>(context.rig.rig, context.obstacles, context.truth);
           })
      .looks = false;
  parts.detectors.add("none", [](const DetectorContext&) { return std::make_unique<NoDetector>(); }).looks = false;

  parts.state_sources.add<FilterConfig>("filter", [](const FilterConfig& config, const StateSourceContext&) {
    return std::make_unique<Filter>(config);
  });
  parts.state_sources.add("truth", [](const StateSourceContext& context) {
    return std::make_unique<TrueState>(context.truth);
  });

  parts.planners.add("sst", make_sst_planner);
  parts.planners.add("rrt", make_rrt_planner);
  parts.planners.add("est", make_est_planner);
  parts.planners.add<ManoeuvreLibraryConfig>(
      "library", [](const ManoeuvreLibraryConfig& library, const PlannerContext& context) {
        return make_library_planner(context, library);
      });
  return parts;
}

}  // namespace

const std::shared_ptr<const Parts>& built_in_parts() {
  static const auto parts = std::make_shared<const Parts>(make_built_in_parts());
  return parts;
}

PartConfigs& PartConfigs::operator=(const PartConfigs& other) {
  std::vector<Entry> entries;
  for (const Entry& entry : other.entries_)
    entries.push_back({entry.name, entry.config ? entry.config->clone() : nullptr});
  entries_ = std::move(entries);
  return *this;
}

Words PartConfigs::names() const {
  Words names;
  for (const Entry& entry : entries_) names.push_back(entry.name);
  return names;
}

AnyConfig* PartConfigs::find(std::string_view name) const {
  for (const Entry& entry : entries_)
    if (entry.name == name) return entry.config.get();
  return nullptr;
}

}  // namespace understory
