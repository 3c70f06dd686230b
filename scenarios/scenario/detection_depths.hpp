#pragma once

#include <string>

#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// Throws ScenarioError, one line, where the rig cannot look at one of the rule's depths or where thresholds
/// are not as many as depths. The line names the keys as the user writes them: `depths_key`, and the section
/// of the thresholds.
void check_depths(const PushbroomConfig& rule, const StereoRig& rig, const std::string& depths_key,
                  const std::string& section);

}  // namespace understory
