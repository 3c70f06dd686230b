#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/flight/flight_track.hpp"

namespace understory {

/// Something that happened at one moment.
struct FlightEvent {
  double t_s = 0;
  std::string kind;  ///< launch, in_view, detected, forgotten, blind, estimate, fallback, fault, outcome
  std::string text;
};

/// How a flight ended, in words, and what led to it.
struct FlightStory {
  std::string outcome;                 ///< one sentence: what, when, by how much
  std::vector<std::string> before;     ///< what was seen and remembered of the obstacle that was hit
  std::vector<FlightEvent> events;     ///< in order of time
  std::optional<std::size_t> touched;  ///< index of the obstacle that was hit
  std::string part;                    ///< of the aircraft that touched it or the ground
  std::optional<Eigen::Vector3d> impact_world;
};

/// Of a flight that has ended. Draws what the camera saw in order to find when the obstacle came into view.
FlightStory story_of(const Flight& flight, const FlightTrack& track);

}  // namespace understory
