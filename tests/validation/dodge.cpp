#include "tests/validation/dodge.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/aircraft/aerodynamics.hpp"

namespace understory {
namespace {

DodgeCommands within_limits(DodgeCommands commands, const Airframe& airframe) {
  const auto cut = [&](double& elevon) {
    elevon = std::clamp(elevon, airframe.elevon_min_rad, airframe.elevon_max_rad);
  };
  std::for_each(commands.left_elevon_rad.begin(), commands.left_elevon_rad.end(), cut);
  std::for_each(commands.right_elevon_rad.begin(), commands.right_elevon_rad.end(), cut);
  for (double& duration : commands.duration_s) duration = std::clamp(duration, 0.02, 1.0);
  return commands;
}

DodgeCommands changed(const DodgeCommands& from, double by, std::mt19937_64& generator) {
  std::normal_distribution<double> elevon(0, by), time(0, 0.3 * by);
  DodgeCommands to = from;
  for (double& angle : to.left_elevon_rad) angle += elevon(generator);
  for (double& angle : to.right_elevon_rad) angle += elevon(generator);
  for (double& duration : to.duration_s) duration += time(generator);
  return to;
}

}  // namespace

double sideways_m(const FreeFlight& air, const Airframe& airframe, const DodgeTask& task,
                  const DodgeCommands& commands) {
  constexpr double longest_s = 3, height_penalty = 5, attack_penalty_m_per_rad_s = 100;
  const AirborneStart start = trimmed_start(airframe, task.airspeed_mps);
  Aircraft aircraft = air.begin(airframe, start);
  Controls controls = start.controls;
  controls.thrust_n = airframe.max_thrust_n;
  const double share = 1 - std::exp(-1.0 / (physics_rate_hz * task.servo_lag_s));
  const double to_go_m = task.distance_m - task.reaction_s * task.airspeed_mps;
  double penalty_m = 0, minimum_height_m = 0;
  for (int step = 0; step < longest_s * physics_rate_hz; ++step) {
    const double t_s = static_cast<double>(step) / physics_rate_hz;
    const std::size_t part = t_s < commands.duration_s[0]                            ? 0
                             : t_s < commands.duration_s[0] + commands.duration_s[1] ? 1
                                                                                     : 2;
    controls.left_elevon_rad += share * (commands.left_elevon_rad[part] - controls.left_elevon_rad);
    controls.right_elevon_rad += share * (commands.right_elevon_rad[part] - controls.right_elevon_rad);
    aircraft.step(controls);
    const Truth& truth = aircraft.truth();
    const Eigen::Vector3d position = truth.T_world_body.translation();
    minimum_height_m = std::min(minimum_height_m, position.z() - start_altitude_m);
    const double attack =
        angle_of_attack_rad(truth.T_world_body.linear().transpose() * truth.velocity_world_mps);
    penalty_m += std::max(0.0, std::abs(attack) - task.angle_of_attack_cap_rad) * attack_penalty_m_per_rad_s /
                 physics_rate_hz;
    if (position.x() < to_go_m) continue;
    penalty_m += height_penalty * std::max(0.0, -minimum_height_m - task.height_lost_m);
    return -position.y() - penalty_m;
  }
  return 0;  // never got there
}

double farthest_sideways_m(const FreeFlight& air, const Airframe& airframe, const DodgeTask& task) {
  constexpr int tries = 400;
  std::mt19937_64 generator(1);
  DodgeCommands best{{-0.6, 0.5, 0.5}, {0.8, 0.5, 0.5}, {0.25, 0.3}};  // roll to the right, pull
  double farthest = sideways_m(air, airframe, task, best);
  // Rechenberg's rule: longer steps after a success, shorter ones after failures, so that one in five
  // succeeds.
  double by = 0.2;
  for (int i = 0; i < tries; ++i) {
    const DodgeCommands candidate = within_limits(changed(best, by, generator), airframe);
    const double reached = sideways_m(air, airframe, task, candidate);
    if (reached > farthest) {
      farthest = reached;
      best = candidate;
      by = std::min(0.4, 1.5 * by);
    } else {
      by = std::max(0.005, by * 0.904);  // 1.5^(-1/4)
    }
  }
  return farthest;
}

}  // namespace understory
