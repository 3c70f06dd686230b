#pragma once

#include <cstdint>
#include <vector>

#include "scenarios/evaluation/obstacle_sightings.hpp"
#include "scenarios/flight/flight_computer.hpp"

namespace understory {

/// What became of the obstacles where an algorithm looks only as often as the aircraft's computer lets it.
struct PacedResult {
  std::int64_t looks = 0;
  std::vector<ObstacleSighting> sightings;
};

/// One algorithm's sightings on that computer: of the frames that arrive while it is busy the newest waits,
/// the others are lost. What was in view is counted on every frame all the same, so that an obstacle is not
/// hidden by a slow algorithm.
class PacedSightings {
 public:
  /// `cost_s`: of a look, on that computer.
  PacedSightings(std::vector<RecordedObject> objects, double baseline_m, double cost_s);

  /// `next_t_ns`: the moment of the frame after this one.
  void add(const EvaluationFrame& frame, std::int64_t next_t_ns, const DetectionGrid& grid,
           const std::vector<ExpectedBlock>& expected, const std::vector<StereoHit>& hits);
  PacedResult result() const { return {looks_, sightings_.passed()}; }

 private:
  FlightComputer computer_;
  ObstacleSightings sightings_;
  std::int64_t looks_ = 0;
};

}  // namespace understory
