#include "scenarios/evaluation/obstacle_sightings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "planning/airframe.hpp"
#include "scenarios/flight/clearance.hpp"

namespace understory {
namespace {

const double half_span_m = 0.5 * Airframe().span_m;  // a scenario can name no other span
constexpr double straight_on_m = 15;                 // farther than any depth looked at
constexpr double passed_by_m = 0.5;                  // the path goes on at least this far beyond

}  // namespace

Share found_within(const std::vector<ObstacleSighting>& sightings, double reach_m, std::int64_t* hidden) {
  Share share;
  for (const ObstacleSighting& sighting : sightings) {
    if (sighting.miss_m > reach_m) continue;
    if (!sighting.hidden())
      share.count(sighting.found());
    else if (hidden != nullptr)
      ++*hidden;
  }
  return share;
}

ObstacleSightings::ObstacleSightings(std::vector<RecordedObject> objects, double baseline_m)
    : objects_(std::move(objects)), baseline_m_(baseline_m) {}

void ObstacleSightings::add(const EvaluationFrame& frame, const DetectionGrid& grid,
                            const std::vector<ExpectedBlock>& expected, const std::vector<StereoHit>& hits) {
  if (!frame.T_world_camera) return;
  path_world_.push_back(*frame.T_world_camera * Eigen::Vector3d(0.5 * baseline_m_, 0, 0));
  for (const ExpectedBlock& block : expected) {
    const DepthInterval& matched = grid.depths[block.depth].half_pixel;
    if (block.mean_depth_m < matched.near_m || block.mean_depth_m > matched.far_m) continue;
    Gathered& gathered = gathered_[block.object];
    if (gathered.sighting.blocks_in_view++ == 0) gathered.seen_at = path_world_.size() - 1;
  }
  for (const StereoHit& hit : hits) {
    const DepthInterval& interval = grid.depths[grid.depth_of(hit)].one_pixel;
    const BlockContent content =
        content_between(frame.truth, hit.column_px, hit.row_px, interval, Surfaces::obstacles);
    if (!content.holds()) continue;
    ObstacleSighting& sighting = gathered_[content.object].sighting;
    ++sighting.hits;
    if (sighting.hits == 1) sighting.first_hit_m = content.mean_depth_m;
    if (sighting.hits == 3) sighting.third_hit_m = content.mean_depth_m;
  }
}

bool ObstacleSightings::would_touch(int object, std::size_t at) const {
  const std::size_t to = std::min(at + 1, path_world_.size() - 1), from = to > 0 ? to - 1 : 0;
  const Eigen::Vector3d step = path_world_[to] - path_world_[from];
  if (step.norm() < 1e-9) return false;
  const Segment ahead{path_world_[at], path_world_[at] + straight_on_m * step.normalized()};
  return std::ranges::any_of(objects_, [&](const RecordedObject& piece) {
    return piece.number == object &&
           segment_distance_m(ahead, {piece.from_world, piece.to_world}) - piece.radius_m <= half_span_m;
  });
}

std::vector<Passing> ObstacleSightings::passings() const {
  std::vector<Passing> passings;
  if (path_world_.size() < 2) return passings;
  std::set<int> done;
  for (const RecordedObject& object : objects_) {
    if (!object.is_obstacle() || object.kind == "branch" || !done.insert(object.number).second) continue;
    double minimum_m = std::numeric_limits<double>::infinity();
    std::size_t nearest = 0;
    for (const RecordedObject& piece : objects_) {
      if (piece.number != object.number) continue;
      for (std::size_t i = 0; i + 1 < path_world_.size(); ++i) {
        const double distance_m =
            segment_distance_m({path_world_[i], path_world_[i + 1]}, {piece.from_world, piece.to_world}) -
            piece.radius_m;
        if (distance_m >= minimum_m) continue;
        minimum_m = distance_m;
        nearest = i;
      }
    }
    if ((path_world_.back() - path_world_[nearest]).norm() >= passed_by_m)
      passings.push_back({object.number, minimum_m});
  }
  return passings;
}

std::vector<ObstacleSighting> ObstacleSightings::passed(const std::vector<Passing>& passings) const {
  std::vector<ObstacleSighting> sightings;
  for (const Passing& passing : passings) {
    ObstacleSighting& sighting = sightings.emplace_back();
    if (const auto found = gathered_.find(passing.object); found != gathered_.end()) {
      sighting = found->second.sighting;
      sighting.on_the_path = would_touch(passing.object, found->second.seen_at);
    }
    sighting.object = passing.object;
    sighting.miss_m = passing.miss_m;
  }
  return sightings;
}

PacedSightings::PacedSightings(std::vector<RecordedObject> objects, double baseline_m, double cost_s)
    : computer_(std::llround(1e9 * cost_s)), sightings_(std::move(objects), baseline_m) {}

void PacedSightings::add(const EvaluationFrame& frame, std::int64_t next_t_ns, const DetectionGrid& grid,
                         const std::vector<ExpectedBlock>& expected, const std::vector<StereoHit>& hits) {
  const bool looked = computer_.will_take(frame.pair.t_ns, next_t_ns);
  if (looked) ++frames_;
  sightings_.add(frame, grid, expected, looked ? hits : std::vector<StereoHit>());
}

}  // namespace understory
