#include "perception/map/local_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "perception/assertion.hpp"

namespace understory {

void PointGrid::clear() {
  heads_.assign(heads_.empty() ? 1024 : heads_.size(), -1);
  next_.clear();
  cells_.clear();
}

std::size_t PointGrid::bucket_of(const Cell& cell) const {
  // Three large odd primes (Teschner et al. 2003, spatial hashing); unsigned arithmetic wraps, which is
  // meant.
  const auto mixed = static_cast<std::uint64_t>(cell[0]) * 73856093u ^
                     static_cast<std::uint64_t>(cell[1]) * 19349663u ^
                     static_cast<std::uint64_t>(cell[2]) * 83492791u;
  return static_cast<std::size_t>(mixed ^ (mixed >> 17)) & (heads_.size() - 1);
}

void PointGrid::add(const Eigen::Vector3d& position) {
  cells_.push_back(cell_of(position));
  next_.push_back(-1);
  if (cells_.size() <= heads_.size()) return link(cells_.size() - 1);
  heads_.assign(heads_.size() * 2, -1);
  for (std::size_t index = 0; index < cells_.size(); ++index) link(index);
}

void PointGrid::link(std::size_t index) {
  int& head = heads_[bucket_of(cells_[index])];
  next_[index] = head;
  head = static_cast<int>(index);
}

int PointGrid::find_in_cell(const Eigen::Vector3d& position) const {
  int found = -1;
  const auto take_first = [&](int index) {
    found = index;
    return false;
  };
  visit_cell(cell_of(position), take_first);
  return found;
}

LocalMap::LocalMap(const LocalMapConfig& config)
    : config_(config), voxels_(config.voxel_m > 0 ? config.voxel_m : 1.0) {
  assert_always(config.max_points > 0, "the map must hold at least one point");
  assert_always(config.neighbour_radius_m > 0, "neighbour_radius_m must be positive");
}

void LocalMap::insert(const std::vector<StereoHit>& hits, const Eigen::Isometry3d& T_world_camera,
                      std::int64_t t_ns, double distance_flown_m) {
  for (const StereoHit& hit : hits) {
    ObstaclePoint point;
    point.position_world = T_world_camera * hit.position_camera;
    point.t_ns = t_ns;
    point.score = hit.score;
    point.distance_flown_m = distance_flown_m;
    if (merge(point)) continue;
    points_.push_back(point);
    voxels_.add(point.position_world);
  }
  if (points_.size() > static_cast<std::size_t>(config_.max_points)) keep_newest();
}

bool LocalMap::merge(const ObstaclePoint& point) {
  if (config_.voxel_m <= 0) return false;
  const int index = voxels_.find_in_cell(point.position_world);
  if (index < 0) return false;
  ObstaclePoint& remembered = points_[static_cast<std::size_t>(index)];
  const int sightings = remembered.sightings + (remembered.t_ns == point.t_ns ? 0 : 1);
  remembered = point;
  remembered.sightings = sightings;
  return true;
}

void LocalMap::forget_passed(const Eigen::Isometry3d& T_world_body, std::int64_t t_ns) {
  const Eigen::Vector3d nose_world = T_world_body.linear().col(0);
  const double level = std::hypot(nose_world.x(), nose_world.y());
  const Eigen::Vector2d heading_world =
      level > 0.1 ? Eigen::Vector2d(nose_world.head<2>() / level) : Eigen::Vector2d::Zero();
  const Eigen::Vector2d here_world = T_world_body.translation().head<2>();
  const auto max_age_ns = static_cast<std::int64_t>(std::llround(config_.max_age_s * 1e9));
  const auto removed = std::erase_if(points_, [&](const ObstaclePoint& point) {
    const double ahead_m = heading_world.dot(point.position_world.head<2>() - here_world);
    return t_ns - point.t_ns > max_age_ns || ahead_m < -config_.passed_m;
  });
  if (removed > 0) rebuild_voxels();
}

void LocalMap::change(const LocalMapConfig& config) {
  const double voxel_m = config_.voxel_m;
  config_ = config;
  config_.voxel_m = voxel_m;
}

void LocalMap::move(const Place& place) {
  std::erase_if(points_, [&](ObstaclePoint& point) {
    const std::optional<Eigen::Vector3d> now = place(point);
    if (now) point.position_world = *now;
    return !now;
  });
  rebuild_voxels();
}

void LocalMap::keep_newest() {
  // The oldest by last sighting, earlier in the order among equals: a strict order, so the choice is unique.
  std::vector<std::pair<std::int64_t, std::size_t>> by_age(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) by_age[i] = {points_[i].t_ns, i};
  const std::size_t excess = points_.size() - static_cast<std::size_t>(config_.max_points);
  const auto oldest_kept = by_age.begin() + static_cast<std::ptrdiff_t>(excess);
  std::nth_element(by_age.begin(), oldest_kept, by_age.end());
  const auto limit = *oldest_kept;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (std::pair(points_[i].t_ns, i) >= limit) points_[kept++] = points_[i];
  points_.resize(kept);
  rebuild_voxels();
}

void LocalMap::rebuild_voxels() {
  voxels_.clear();
  for (const ObstaclePoint& point : points_) voxels_.add(point.position_world);
}

std::vector<ObstaclePoint> LocalMap::trusted_points() const {
  PointGrid grid(
      std::max(config_.neighbour_radius_m, config_.seen_again ? config_.seen_again_radius_m : 0.0));
  for (const ObstaclePoint& point : points_) grid.add(point.position_world);
  std::vector<ObstaclePoint> kept;
  kept.reserve(points_.size());
  for (std::size_t index = 0; index < points_.size(); ++index)
    if (trusted(index, grid)) kept.push_back(points_[index]);
  return kept;
}

bool LocalMap::trusted(std::size_t index, const PointGrid& grid) const {
  const ObstaclePoint& point = points_[index];
  int neighbours = 0;
  bool seen_again = !config_.seen_again || point.sightings > 1;
  const auto enough = [&] { return neighbours >= config_.min_neighbours && seen_again; };
  if (enough()) return true;
  grid.visit_near(point.position_world, [&](int other_index) {
    const ObstaclePoint& other = points_[static_cast<std::size_t>(other_index)];
    if (static_cast<std::size_t>(other_index) == index) return true;
    const double distance_m = (other.position_world - point.position_world).norm();
    if (distance_m <= config_.neighbour_radius_m) ++neighbours;
    if (distance_m <= config_.seen_again_radius_m && other.t_ns != point.t_ns) seen_again = true;
    return !enough();
  });
  return enough();
}

}  // namespace understory
