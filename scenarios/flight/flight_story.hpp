#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/flight/flight_log.hpp"

namespace understory {

/// Something that happened at one moment.
struct FlightEvent {
  double t_s = 0;
  std::string kind;  ///< launch, in_view, detected, forgotten, blind, estimate, fallback, fault, outcome
  std::string text;
};

/// What the aircraft knew of the obstacle that it hit.
struct ObstacleStory {
  std::size_t obstacle = 0;          ///< its index
  bool has_camera = false;           ///< whether it could come into view at all
  std::optional<double> in_view_s;   ///< first time that the left camera saw enough of it
  double in_view_m = 0;              ///< from the aircraft's centre to its surface, then
  std::optional<double> detected_s;  ///< exposure of the first frame with a hit on it
  double detected_m = 0;             ///< as in_view_m
  std::int64_t hits = 0, frames_with_hits = 0;
  /// Whether it was ever in view while it stood at a depth that the detector compares (pushbroom only).
  std::optional<bool> in_view_at_depth;
  std::int64_t points = 0;     ///< in the map for it at the end
  double nearest_point_m = 0;  ///< of those, from its surface; negative within
  /// From the nearest place on its axis or face to the points' middle, world axes.
  Eigen::Vector3d points_off_world = Eigen::Vector3d::Zero();
  std::optional<double> forgotten_s;  ///< when the map lost its last point of it, if it held any
};

/// How a flight ended and what led to it: measurements, and words made of them.
struct FlightStory {
  std::optional<ObstacleStory> touched;  ///< of a collision
  std::vector<FlightEvent> events;       ///< in order of time
  std::string outcome;                   ///< one sentence: what, when, by how much
  std::vector<std::string> before;       ///< sentences: what was seen and remembered, and of the plan
};

/// Of a log that is complete.
FlightStory story_of(const FlightLog& log);

/// The bound through which a flight that is out of bounds left its course: "upper", "lower", "left", "right"
/// or "back".
std::string_view bound_left(const FlightLog& log);

/// Fills in what a result says of a lost flight.
void add_loss(const FlightLog& log, FlightResult& result);

/// Depths at which the pushbroom compares images; none for other detectors.
std::vector<double> compared_depths_m(const FlightLog& log);

}  // namespace understory
