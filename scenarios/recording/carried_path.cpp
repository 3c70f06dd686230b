#include "scenarios/recording/carried_path.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "perception/assertion.hpp"
#include "perception/io/text_file.hpp"
#include "scenarios/config/bad_input.hpp"
#include "scenarios/config/named_seed.hpp"
#include "scenarios/flight/clearance.hpp"

namespace understory {
namespace {

constexpr double fastest_mps = 100;
constexpr int longest_s = 3600;  // 430,000 frames, some 100 GB
constexpr double widest_turn_rad = std::numbers::pi / 2;
constexpr std::int64_t closest_ns = 50'000'000;

constexpr double shoulder_room_m = 0.5;  // between the lane and the next trunk
constexpr double pi = std::numbers::pi, degree = pi / 180;

double room_beside(const Segment& lane, const std::vector<Obstacle>& obstacles) {
  double room_m = std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : obstacles) room_m = std::min(room_m, obstacle_distance_m(lane, obstacle));
  return room_m;
}

Eigen::Isometry3d pose_at(const WalkPath& path, double t_s) {
  const double speed_mps = path.config.speed_mps;
  const double step_hz = 1.8 * speed_mps / 1.4;  // the length of a step stays the same
  const auto swing = [&](double hz, std::size_t phase) {
    return std::sin(2 * pi * hz * t_s + path.phases_rad[phase]);
  };
  const Eigen::Vector3d position_world(path.from_x_m + speed_mps * t_s,
                                       path.lane_y_m + 0.025 * swing(step_hz / 2, 1),
                                       path.config.height_m + 0.02 * swing(step_hz, 0));
  const double yaw_rad = degree * swing(step_hz / 2, 2) + 2 * degree * swing(0.1, 3);
  const double pitch_rad = path.pitch_rad + 0.6 * degree * swing(step_hz, 0);
  const double roll_rad = degree * swing(step_hz / 2, 1);
  return Eigen::Translation3d(position_world) * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX());
}

}  // namespace

std::vector<TimedPose> read_path(const std::filesystem::path& file) {
  const std::vector<TimedPose> poses =
      bad_input_if_refused([&] { return read_poses(file, Repeats::skipped); });
  if (poses.size() < 2)
    throw ScenarioError(fmt::format("{}: a path needs at least two poses, here is one", file.string()));
  const double span_s = static_cast<double>(poses.back().t_ns - poses.front().t_ns) * 1e-9;
  if (span_s > longest_s)
    throw ScenarioError(fmt::format(
        "{}: a path may take at most {} s from the first pose to the last, this one takes {:.0f} s",
        file.string(), longest_s, span_s));
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Eigen::Isometry3d step = poses[i - 1].T_world_body.inverse() * poses[i].T_world_body;
    const double step_s = static_cast<double>(poses[i].t_ns - poses[i - 1].t_ns) * 1e-9;
    const auto fail_unless = [&](bool holds, const char* what) {
      if (!holds)
        refuse_input(place_in(file.string(), poses[i].line), "",
                     fmt::format("must be {} from the pose before", what));
    };
    fail_unless(step.translation().norm() <= fastest_mps * step_s, "at most 100 m/s");
    fail_unless(Eigen::AngleAxisd(step.linear()).angle() <= widest_turn_rad, "at most a quarter turn");
  }
  return poses;
}

std::vector<TimedPose> thinned(const std::vector<TimedPose>& poses) {
  std::vector<TimedPose> kept;
  for (const TimedPose& pose : poses)
    if (kept.empty() || pose.t_ns - kept.back().t_ns >= closest_ns) kept.push_back(pose);
  if (poses.size() < 2 || kept.back().t_ns == poses.back().t_ns) return kept;
  if (kept.size() > 1) kept.pop_back();  // a longer last piece instead of a short one
  kept.push_back(poses.back());
  return kept;
}

SmoothPath::SmoothPath(const std::vector<TimedPose>& poses) {
  assert_always(poses.size() >= 2, "a path has at least two poses");
  for (const TimedPose& pose : poses) {
    Channels value;
    const Eigen::Quaterniond q(pose.T_world_body.linear());
    value << pose.T_world_body.translation(), q.w(), q.x(), q.y(), q.z();
    if (!values_.empty() && value.tail<4>().dot(values_.back().tail<4>()) < 0) value.tail<4>() *= -1;
    values_.push_back(value);
    times_s_.push_back(static_cast<double>(pose.t_ns - poses.front().t_ns) * 1e-9);
  }
  solve_second_derivatives();
}

/// Solves the tridiagonal system of a natural cubic spline by forward elimination.
void SmoothPath::solve_second_derivatives() {
  const std::size_t count = values_.size();
  second_derivatives_.assign(count, Channels::Zero());
  std::vector<double> shares(count, 0);  // of the next knot's in this one's
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double before_s = times_s_[i] - times_s_[i - 1], after_s = times_s_[i + 1] - times_s_[i];
    const Channels slopes_apart =
        (values_[i + 1] - values_[i]) / after_s - (values_[i] - values_[i - 1]) / before_s;
    const double diagonal_s = 2 * (before_s + after_s) - before_s * shares[i - 1];
    shares[i] = after_s / diagonal_s;
    second_derivatives_[i] = (6 * slopes_apart - before_s * second_derivatives_[i - 1]) / diagonal_s;
  }
  for (std::size_t i = count - 2; i > 0; --i)
    second_derivatives_[i] -= shares[i] * second_derivatives_[i + 1];
}

Eigen::Isometry3d SmoothPath::at(double t_s) const {
  const auto later = std::upper_bound(times_s_.begin() + 1, times_s_.end() - 1, t_s);
  const auto i = static_cast<std::size_t>(later - times_s_.begin());
  const double h_s = times_s_[i] - times_s_[i - 1];
  const double a = (times_s_[i] - t_s) / h_s, b = 1 - a;
  const Channels value =
      a * values_[i - 1] + b * values_[i] +
      h_s * h_s / 6 *
          ((a * a * a - a) * second_derivatives_[i - 1] + (b * b * b - b) * second_derivatives_[i]);
  const Eigen::Quaterniond q(value[3], value[4], value[5], value[6]);
  return Eigen::Translation3d(value.head<3>()) * q.normalized();
}

Truth carried_truth(const CarriedPose& pose_at, std::int64_t t_ns, double gravity_mps2) {
  constexpr double h_s = 1e-4;
  const double t_s = static_cast<double>(t_ns) * 1e-9;
  const Eigen::Isometry3d before = pose_at(t_s - h_s), now = pose_at(t_s), after = pose_at(t_s + h_s);
  Truth truth;
  truth.t_ns = t_ns;
  truth.T_world_body = now;
  truth.velocity_world_mps = (after.translation() - before.translation()) / (2 * h_s);
  const Eigen::AngleAxisd turned(Eigen::Matrix3d(before.linear().transpose() * after.linear()));
  truth.angular_rate_body_radps = turned.angle() * turned.axis() / (2 * h_s);
  const Eigen::Vector3d acceleration_world_mps2 =
      (after.translation() - 2 * now.translation() + before.translation()) / (h_s * h_s);
  truth.specific_force_body_mps2 =
      now.linear().transpose() * (acceleration_world_mps2 + gravity_mps2 * Eigen::Vector3d::UnitZ());
  return truth;
}

WalkPath walk_path(const WalkConfig& config, const Scenario& scenario, const StereoRig& rig,
                   const std::vector<Obstacle>& obstacles) {
  constexpr double before_m = 10, lane_step_m = 0.1;
  WalkPath path;
  path.config = config;
  path.gravity_mps2 = scenario.airframe.gravity_mps2;
  double first_x_m = before_m;
  if (!obstacles.empty()) {
    first_x_m = std::numeric_limits<double>::infinity();
    for (const Obstacle& obstacle : obstacles)
      first_x_m = std::min({first_x_m, obstacle.from_world.x(), obstacle.to_world.x()});
  }
  path.from_x_m = std::clamp(first_x_m - before_m, 0.0, scenario.goal_x_m() - 1);
  const Eigen::Vector3d gaze_body = rig.T_body_camera.linear().col(2);
  path.pitch_rad = std::atan2(gaze_body.z(), gaze_body.x());  // positive about y lowers the nose

  const auto lane_is_free = [&](double y_m) {
    return room_beside({{path.from_x_m, y_m, config.height_m}, {scenario.goal_x_m(), y_m, config.height_m}},
                       obstacles) >= shoulder_room_m;
  };
  const int lanes = static_cast<int>(scenario.forest.half_width_m / lane_step_m);
  bool found = false;
  for (int lane = 0; lane <= 2 * lanes && !found; ++lane) {  // 0, 1 left, 1 right, 2 left ...
    const int steps_left = lane % 2 == 1 ? (lane + 1) / 2 : -(lane / 2);
    path.lane_y_m = lane_step_m * steps_left;
    found = lane_is_free(path.lane_y_m);
  }
  if (!found)
    throw ScenarioError(fmt::format(
        "--walk: no straight lane with {} m to every obstacle in {} with seed {}: take another seed",
        shoulder_room_m, scenario.name, scenario.seed));
  std::mt19937_64 generator(seed_for(scenario.seed, "walk"));
  for (double& phase_rad : path.phases_rad)
    phase_rad = 2 * pi * static_cast<double>(generator() >> 11) / 9007199254740992.0;  // 2^53
  return path;
}

Truth walk_truth(const WalkPath& path, std::int64_t t_ns) {
  return carried_truth([&](double t_s) { return pose_at(path, t_s); }, t_ns, path.gravity_mps2);
}

}  // namespace understory
