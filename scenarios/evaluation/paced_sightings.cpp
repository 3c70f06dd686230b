#include "scenarios/evaluation/paced_sightings.hpp"

#include <cmath>
#include <utility>

namespace understory {

PacedSightings::PacedSightings(std::vector<RecordedObject> objects, double baseline_m, double cost_s)
    : computer_(std::llround(1e9 * cost_s)), sightings_(std::move(objects), baseline_m) {}

void PacedSightings::add(const EvaluationFrame& frame, std::int64_t next_t_ns, const DetectionGrid& grid,
                         const std::vector<ExpectedBlock>& expected, const std::vector<StereoHit>& hits) {
  const bool looked = computer_.will_take(frame.pair.t_ns, next_t_ns);
  if (looked) ++looks_;
  sightings_.add(frame, grid, expected, looked ? hits : std::vector<StereoHit>());
}

}  // namespace understory
