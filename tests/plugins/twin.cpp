// Our own detector and planner under other names: flights must have the digests of ours.
#include "scenarios/scenario/plugin.hpp"

UNDERSTORY_PLUGIN(parts) {
  understory::DetectorPart detector = *parts.detectors.find("pushbroom");
  detector.name = "pushbroom_twin";
  parts.detectors.add(detector);
  understory::PlannerPart planner = *parts.planners.find("sst");
  planner.name = "sst_twin";
  parts.planners.add(planner);
}
