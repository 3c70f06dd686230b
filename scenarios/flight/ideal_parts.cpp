#include "scenarios/flight/ideal_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "scenarios/output/errors.hpp"
#include "sim/sensors/faults.hpp"

namespace understory {
namespace {

constexpr double sight_m = 40, reach_up_m = 4, apart_m = 0.5;
constexpr std::int64_t sight_period_ns = 250'000'000;
constexpr int longer_search = 20;

/// The depths that the scenario's detector looks at, one pixel of disparity either way; those of full stereo
/// are one interval.
std::vector<DepthInterval> intervals_of(const Scenario& scenario, const StereoRig& rig) {
  const DetectorPart& part = scenario.perception.part();
  std::vector<DepthInterval> intervals;
  if (part.depths_m) intervals = intervals_around(part.depths_m(scenario, rig), rig);
  if (intervals.empty())
    intervals.push_back(
        {scenario.perception.full_stereo.minimum_depth_m, scenario.perception.full_stereo.maximum_depth_m});
  return intervals;
}

/// Points on the side of a round obstacle between two heights, towards the eye and to both sides of it.
void add_side(const Obstacle& obstacle, const Eigen::Vector3d& eye_world, std::vector<Eigen::Vector3d>& to) {
  const Eigen::Vector3d along = obstacle.to_world - obstacle.from_world;
  const int count = std::max(1, static_cast<int>(std::ceil(along.norm() / apart_m)));
  for (int i = 0; i <= count; ++i) {
    const Eigen::Vector3d centre = obstacle.from_world + along * i / count;
    if (std::abs(centre.z() - eye_world.z()) > reach_up_m) continue;
    Eigen::Vector3d towards = eye_world - centre;
    if (along.norm() > 0) towards -= along * (along.dot(towards) / along.squaredNorm());
    if (towards.norm() < 1e-6) continue;
    towards.normalize();
    const Eigen::Vector3d aside = along.norm() > 0 ? Eigen::Vector3d(along.normalized().cross(towards))
                                                   : Eigen::Vector3d(towards.unitOrthogonal());
    for (const Eigen::Vector3d& direction : {towards, aside, Eigen::Vector3d(-aside)})
      to.push_back(centre + obstacle.radius_m * direction);
  }
}

/// Points all over a wall or a box.
void add_faces(const Obstacle& obstacle, const Eigen::Vector3d& eye_world, std::vector<Eigen::Vector3d>& to) {
  Eigen::Isometry3d T_world_box = obstacle.T_world_box();
  Eigen::Vector3d half = obstacle.half_size_m;
  if (obstacle.kind == ObstacleKind::wall) {
    const Eigen::Vector3d along = obstacle.to_world - obstacle.from_world;
    half = {along.head<2>().norm() / 2, obstacle.radius_m, std::abs(along.z()) / 2};
    T_world_box = Eigen::AngleAxisd(std::atan2(along.y(), along.x()), Eigen::Vector3d::UnitZ());
    T_world_box.translation() = obstacle.from_world + along / 2;
  }
  const Eigen::Vector3i count = (half * 2 / apart_m).array().ceil().cast<int>().max(1);
  for (int x = 0; x <= count.x(); ++x)
    for (int y = 0; y <= count.y(); ++y)
      for (int z = 0; z <= count.z(); ++z) {
        const Eigen::Vector3i at(x, y, z);
        if (((at.array() > 0) && (at.array() < count.array())).all()) continue;  // inside
        const Eigen::Vector3d place =
            T_world_box * Eigen::Vector3d(half.array() *
                                          (2 * at.cast<double>().array() / count.cast<double>().array() - 1));
        if (std::abs(place.z() - eye_world.z()) <= reach_up_m) to.push_back(place);
      }
}

/// No detector sees what a camera's cover hides.
class UncoveredDetector : public ObstacleDetector {
 public:
  UncoveredDetector(std::unique_ptr<ObstacleDetector> detector, const std::vector<FaultConfig>& faults,
                    int width_px)
      : detector_(std::move(detector)), faults_(faults), width_px_(width_px) {}
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override {
    hits_ = detector_->detect(frame);
    if (const auto cover = faults_.value(FaultySensor::camera, FaultKind::cover, frame.t_ns)) {
      const auto [first, end] = free_columns(*cover, width_px_);
      std::erase_if(hits_, [first, end](const StereoHit& hit) {
        return hit.column_px < first || hit.column_px >= end;
      });
    }
    return hits_;
  }

 private:
  std::unique_ptr<ObstacleDetector> detector_;
  Faults faults_;
  int width_px_;
  std::vector<StereoHit> hits_;
};

template <typename Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename Value>
bool take(std::string_view& bytes, Value& value) {
  if (bytes.size() < sizeof value) return false;
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return true;
}

constexpr std::string_view hits_mark = "understory hits 1\n";

}  // namespace

bool is_ideal(const Scenario& scenario, std::string_view part) {
  return std::ranges::find(scenario.ideal.parts, part) != scenario.ideal.parts.end();
}

std::unique_ptr<ObstacleDetector> ideal_detector(const Scenario& scenario, const StereoRig& rig,
                                                 const std::vector<Obstacle>& obstacles,
                                                 const TruthHistory& truth) {
  if (is_ideal(scenario, "sight")) return std::make_unique<AllAround>(rig, obstacles, truth);
  if (is_ideal(scenario, "detection"))
    return std::make_unique<UncoveredDetector>(
        std::make_unique<TrueDepth>(rig, obstacles, truth, intervals_of(scenario, rig)), scenario.faults,
        rig.width_px);
  return nullptr;
}

AutopilotConfig with_ideal_parts(AutopilotConfig config, const Scenario& scenario) {
  if (is_ideal(scenario, "map") || is_ideal(scenario, "sight"))
    config.map.max_points = std::max(config.map.max_points, 50'000);
  if (is_ideal(scenario, "map")) {
    config.map.max_age_s = 1000;
    config.map.min_neighbours = 0;
    config.map.seen_again = false;
  }
  if (is_ideal(scenario, "latency")) config.plan_latency_s = 0, config.plan_cost = {};
  if (is_ideal(scenario, "search")) {
    config.planner.search.iterations *= longer_search;
    config.planner.improvement.iterations *= longer_search;
  }
  return config;
}

AllAround::AllAround(const StereoRig& rig, const std::vector<Obstacle>& obstacles, const TruthHistory& truth)
    : rig_(rig), obstacles_(obstacles), truth_(truth) {}

const std::vector<StereoHit>& AllAround::detect(const StereoFrame& frame) {
  hits_.clear();
  if (frame.t_ns < next_ns_) return hits_;
  next_ns_ = frame.t_ns + sight_period_ns;
  const Eigen::Isometry3d T_world_camera = truth_.at(frame.t_ns).T_world_body * rig_.T_body_camera;
  const Eigen::Vector3d eye_world = T_world_camera.translation();
  std::vector<Eigen::Vector3d> places;
  for (const Obstacle& obstacle : obstacles_) {
    const Eigen::Vector2d from = obstacle.from_world.head<2>(), along = obstacle.to_world.head<2>() - from;
    const double share =
        along.norm() > 0 ? std::clamp((eye_world.head<2>() - from).dot(along) / along.squaredNorm(), 0.0, 1.0)
                         : 0;
    if ((eye_world.head<2>() - from - share * along).norm() > sight_m) continue;
    if (obstacle.kind == ObstacleKind::wall || obstacle.kind == ObstacleKind::box)
      add_faces(obstacle, eye_world, places);
    else
      add_side(obstacle, eye_world, places);
  }
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  for (const Eigen::Vector3d& place : places) hits_.push_back({T_camera_world * place, 0, 0, 0, 0, 0, {}});
  return hits_;
}

std::string to_bytes(const KnownHits& known) {
  std::string bytes(hits_mark);
  for (const auto& [t_ns, hits] : known) {
    append(bytes, t_ns);
    append(bytes, static_cast<std::uint64_t>(hits.size()));
    for (const StereoHit& hit : hits) {
      for (int axis = 0; axis < 3; ++axis) append(bytes, hit.position_camera[axis]);
      append(bytes, hit.column_px);
      append(bytes, hit.row_px);
      for (const double value :
           {hit.disparity_px, hit.score, hit.edge_sum, hit.depth.near_m, hit.depth.far_m})
        append(bytes, value);
    }
  }
  return bytes;
}

KnownHits known_hits_from_bytes(const std::string& bytes, const std::string& name) {
  const auto refuse = [&name](const char* why) { throw ScenarioError(fmt::format("{}: {}", name, why)); };
  if (!bytes.starts_with(hits_mark)) refuse("is no file of hits that understory explain wrote");
  std::string_view rest = std::string_view(bytes).substr(hits_mark.size());
  KnownHits known;
  while (!rest.empty()) {
    std::int64_t t_ns = 0;
    std::uint64_t count = 0;
    bool is_whole = take(rest, t_ns) && take(rest, count) && count <= rest.size();
    std::vector<StereoHit> hits(is_whole ? count : 0);
    for (StereoHit& hit : hits) {
      for (int axis = 0; axis < 3; ++axis) is_whole = is_whole && take(rest, hit.position_camera[axis]);
      is_whole = is_whole && take(rest, hit.column_px) && take(rest, hit.row_px);
      for (double* value :
           {&hit.disparity_px, &hit.score, &hit.edge_sum, &hit.depth.near_m, &hit.depth.far_m})
        is_whole = is_whole && take(rest, *value);
    }
    if (!is_whole) refuse("is cut short");
    known[t_ns] = std::move(hits);
  }
  return known;
}

Eigen::Isometry3d pose_of(const FlightState& state) {
  const Eigen::Vector3d direction = Eigen::Vector3d(
      std::cos(state.climb_angle_rad) * std::cos(state.heading_rad),
      std::cos(state.climb_angle_rad) * std::sin(state.heading_rad), std::sin(state.climb_angle_rad));
  const Eigen::Vector3d level_left(-std::sin(state.heading_rad), std::cos(state.heading_rad), 0);
  const Eigen::Vector3d up = direction.cross(level_left);
  const double slip = state.sideslip_rad, attack = state.angle_of_attack_rad;
  const Eigen::Vector3d left =
      std::sin(slip) * direction +
      std::cos(slip) * (std::cos(state.bank_rad) * level_left + std::sin(state.bank_rad) * up);
  const Eigen::Vector3d ahead = (direction - std::sin(slip) * left) / std::cos(slip),
                        above = ahead.cross(left);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << std::cos(attack) * ahead + std::sin(attack) * above, left,
      std::cos(attack) * above - std::sin(attack) * ahead;
  pose.translation() = state.position_world;
  return pose;
}

}  // namespace understory
