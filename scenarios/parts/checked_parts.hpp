#pragma once

#include <cstddef>
#include <memory>

#include "scenarios/parts/parts.hpp"

/// Makes parts. Those of plug-ins are wrapped in checks of each call's result. A part that breaks its
/// interface's promises ends the flight with MachineError, one line that names file, part and call; this is a
/// failure of the machine, not of the aircraft. A call that does not return within 20 s of wall time ends the
/// process with such a line and status 3. Our own parts have no checks: their tests suffice.
namespace understory {

/// Most obstacles that a course may have: more take a minute to build.
inline constexpr std::size_t maximum_obstacles = 20'000;

/// Hits must be finite, lie within the rig's image and come from top to bottom.
std::unique_ptr<ObstacleDetector> checked(const DetectorPart& part, const FlightContext& context);
/// States must be finite, and their times must not go back.
std::unique_ptr<StateSource> checked(const StateSourcePart& part, const FlightContext& context);
/// A plan must take effect at the requested time, and have finite points, the first at 0 s, in order of time.
std::unique_ptr<Planner> checked(const PlannerPart& part, const PlannerPartContext& context);
/// The course's obstacles, which must be finite, at most maximum_obstacles, each with a positive radius or
/// box.
Planted checked(const CoursePart& part, const CourseContext& context);

}  // namespace understory
