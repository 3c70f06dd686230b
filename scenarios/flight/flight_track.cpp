#include "scenarios/flight/flight_track.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "planning/path_follower.hpp"
#include "scenarios/flight/clearance.hpp"

namespace understory {
namespace {

constexpr std::int64_t moment_every_steps = physics_rate_hz / 120;

double bank_rad(const Eigen::Isometry3d& T_world_body) {
  return std::atan2(T_world_body.linear()(2, 1), T_world_body.linear()(2, 2));
}

using Place = std::array<double, 3>;
Place place_of(const Eigen::Vector3d& position) { return {position.x(), position.y(), position.z()}; }

/// Plans speak of heights above the ground, the map of those of the odometry frame.
Eigen::Vector3d ground_world(const Flight& flight) {
  const State& state = flight.state();
  return (state.T_world_body.translation().z() - state.altitude_m) * Eigen::Vector3d::UnitZ();
}

}  // namespace

TrackMoment moment_of(const Flight& flight) {
  const Truth& truth = flight.truth();
  const State& state = flight.state();
  TrackMoment moment;
  moment.t_s = flight.clock().t_s();
  moment.T_world_true = truth.T_world_body;
  moment.T_world_estimated = state.T_world_body;
  moment.speed_mps = truth.velocity_world_mps.norm();
  moment.estimated_speed_mps = state.velocity_body_mps.norm();
  moment.estimated_altitude_m = state.altitude_m;
  moment.bank_rad = bank_rad(truth.T_world_body);
  moment.estimated_bank_rad = bank_rad(state.T_world_body);
  moment.commanded_bank_rad = command_at(flight.plan(), flight.clock().t_ns()).bank_rad;
  moment.left_elevon_rad = truth.left_elevon_rad;
  moment.right_elevon_rad = truth.right_elevon_rad;
  moment.clearance_m = clearance_m(truth.T_world_body, flight.scenario().airframe, flight.obstacles());
  moment.position_error_world = state.T_world_body.translation() - truth.T_world_body.translation();
  moment.position_sigma_world =
      state.covariance.diagonal().segment<3>(position_block).cwiseMax(0).cwiseSqrt();
  moment.hits = static_cast<int>(flight.hits().size());
  return moment;
}

std::vector<Eigen::Vector3d> planned_way_world(const Flight& flight) {
  std::vector<Eigen::Vector3d> way_world;
  for (const PlanPoint& point : flight.plan().points)
    way_world.push_back(point.position_world + ground_world(flight));
  return way_world;
}

void TrackRecorder::on_frame(const Flight& flight) {
  const std::int64_t t_ns = flight.frame().t_ns;
  const Truth& truth = flight.truth_at(t_ns);
  const Eigen::Isometry3d T_world_camera = truth.T_world_body * flight.rig().rig.T_body_camera;
  track_.frames.push_back({t_ns, truth, track_.hits_world.size(), flight.hits().size()});
  for (const StereoHit& hit : flight.hits())
    track_.hits_world.push_back(T_world_camera * hit.position_camera);
  follow_map(flight);
}

/// A point that was seen again elsewhere ends, and another begins.
void TrackRecorder::follow_map(const Flight& flight) {
  const double now_s = flight.clock().t_s();
  std::map<Place, std::size_t> before;
  for (const std::size_t index : remembered_)
    before.emplace(place_of(track_.points[index].position_world), index);
  remembered_.clear();
  for (const ObstaclePoint& point : flight.map().points()) {
    const auto known = before.find(place_of(point.position_world));
    if (known == before.end()) {
      remembered_.push_back(track_.points.size());
      track_.points.push_back({point.position_world, now_s, now_s});
    } else {
      remembered_.push_back(known->second);
      before.erase(known);
    }
  }
  for (const auto& [place, index] : before) track_.points[index].to_s = now_s;
}

void TrackRecorder::on_step(const Flight& flight) {
  if (flight.launched() && !launched_) {
    launched_ = true;
    track_.launch_s = flight.clock().t_s();
  }
  const Plan& plan = flight.plan();
  if (plan.t_ns != plan_t_ns_ && !plan.points.empty()) {
    plan_t_ns_ = plan.t_ns;
    track_.plans.push_back({flight.clock().t_s(), plan.origin, planned_way_world(flight), plan.clearance_m});
  }
  if (flight.clock().step() % moment_every_steps == 0) track_.moments.push_back(moment_of(flight));
}

FlightTrack TrackRecorder::finish(const Flight& flight) {
  const double end_s = flight.clock().t_s();
  if (track_.moments.empty() || track_.moments.back().t_s < end_s)
    track_.moments.push_back(moment_of(flight));
  for (const std::size_t index : remembered_) track_.points[index].to_s = end_s;
  return std::move(track_);
}

}  // namespace understory
