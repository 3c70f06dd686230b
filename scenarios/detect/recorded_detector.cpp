#include "scenarios/detect/recorded_detector.hpp"

#include <fmt/format.h>

#include "scenarios/output/errors.hpp"
#include "scenarios/parts/checked_parts.hpp"

namespace understory {

RecordedDetector::RecordedDetector(const VisionConfig& config, const std::string& name, const StereoRig& rig)
    : rig_{rig, {}} {
  const DetectorPart& part = *parts().detectors.find(name);
  if (!part.needs_images)
    throw ScenarioError(
        fmt::format("perception.detector: {} looks at no images; recordings have nothing else", name));
  scenario_.perception = config;
  scenario_.perception.detector = name;
  detector_ = checked(part, {scenario_, rig_, no_obstacles_, truth_, 1});
}

double RecordedDetector::cost_s() const {
  const PerceptionSection& perception = scenario_.perception;
  return perception.part().cost_s ? perception.compute.factor * perception.part().cost_s(perception) : 0;
}

}  // namespace understory
