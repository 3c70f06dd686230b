#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "planning/path_follower.hpp"
#include "scenarios/parts/oracles.hpp"
#include "sim/aircraft/aerodynamics.hpp"
#include "tests/validation/sections.hpp"

namespace understory {
namespace {

/// Elevons held at three pairs of deflections, one after the other: roll, pull, and what then is best. Three
/// of the left elevon, three of the right (rad), and how long the first two pairs last (s).
using DodgeCommands = std::array<double, 8>;

struct DodgeTask {
  double airspeed_mps = 12;
  double distance_m = 10;     ///< ahead, from where the obstacle is seen
  double reaction_s = 0;      ///< flown straight on before anything is done
  double servo_lag_s = 0.03;  ///< what [14] counts with; the simulator's elevons have none by default
  double height_lost_m = 0.5;
  double angle_of_attack_cap_rad = 30 * degree;
};

/// Each number changed at random, within its limits.
DodgeCommands changed(DodgeCommands commands, double by, const Airframe& airframe,
                      std::mt19937_64& generator) {
  std::normal_distribution<double> draw;
  for (std::size_t i = 0; i < 6; ++i)
    commands[i] =
        std::clamp(commands[i] + by * draw(generator), airframe.elevon_min_rad, airframe.elevon_max_rad);
  for (std::size_t i = 6; i < 8; ++i)
    commands[i] = std::clamp(commands[i] + 0.3 * by * draw(generator), 0.02, 1.0);
  return commands;
}

/// How far to the right the aircraft is when it has come `distance_m` ahead, less a penalty for height lost
/// and angle of attack beyond what the task allows.
double sideways_m(const FreeFlight& air, const Airframe& airframe, const DodgeTask& task,
                  const DodgeCommands& commands) {
  constexpr double longest_s = 3, height_penalty = 5, attack_penalty_m_per_rad_s = 100;
  const AirborneStart start = trimmed_start(airframe, task.airspeed_mps);
  Aircraft aircraft = air.begin(airframe, start);
  Controls controls = start.controls;
  controls.thrust_n = airframe.max_thrust_n;
  const double share = 1 - std::exp(-1.0 / (physics_rate_hz * task.servo_lag_s));
  const double to_go_m = task.distance_m - task.reaction_s * task.airspeed_mps;
  const double second_s = commands[6], third_s = second_s + commands[7];
  double penalty_m = 0, minimum_height_m = 0;
  for (int step = 0; step < longest_s * physics_rate_hz; ++step) {
    const double t_s = static_cast<double>(step) / physics_rate_hz;
    const std::size_t part = t_s < second_s ? 0 : t_s < third_s ? 1 : 2;
    controls.left_elevon_rad += share * (commands[part] - controls.left_elevon_rad);
    controls.right_elevon_rad += share * (commands[3 + part] - controls.right_elevon_rad);
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

/// The farthest that a random search of fixed seed finds: a lower bound of what the airframe can do.
double farthest_sideways_m(const FreeFlight& air, const Airframe& airframe, const DodgeTask& task) {
  constexpr int tries = 400;
  std::mt19937_64 generator(1);
  DodgeCommands best{-0.6, 0.5, 0.5, 0.8, 0.5, 0.5, 0.25, 0.3};  // roll to the right, pull
  double farthest = sideways_m(air, airframe, task, best);
  // Rechenberg's rule: longer steps after a success, shorter ones after failures, so that one in five
  // succeeds.
  double by = 0.2;
  for (int i = 0; i < tries; ++i) {
    const DodgeCommands candidate = changed(best, by, airframe, generator);
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

constexpr double jog_speed_mps = 12.3, jog_bank_rad = 60 * degree;
constexpr double jog_half_s = 0.6;  // to either side: as long as the real left jog holds its bank

struct JogMoment {
  double t_s, speed_mps, climbed_m, bank_deg, aside_m;
};

/// Bank to the right, then to the left, then level, at the follower's hands; the climb command returns to the
/// height. At every physics step.
std::vector<JogMoment> flown_jog(const FreeFlight& air, const Airframe& airframe) {
  constexpr double longest_s = 6, climb_per_s = 1.2;  // the course guidance's altitude gain
  constexpr int physics_steps_per_control = 6;        // 200 Hz
  FlightModelConfig config;
  config.cruise_speed_mps = jog_speed_mps;
  const FlightModel model(airframe, config);
  Aircraft aircraft = air.begin(airframe, trimmed_start(airframe, jog_speed_mps));
  std::vector<JogMoment> jog;
  Controls controls;
  for (int step = 0; step < longest_s * physics_rate_hz; ++step) {
    const double t_s = static_cast<double>(step) / physics_rate_hz;
    const Truth& truth = aircraft.truth();
    const Eigen::Vector3d position = truth.T_world_body.translation();
    const double climbed_m = position.z() - start_altitude_m;
    if (step % physics_steps_per_control == 0) {
      const double bank = t_s < jog_half_s ? jog_bank_rad : t_s < 2 * jog_half_s ? -jog_bank_rad : 0;
      controls = follow(model, {}, {bank, std::clamp(-climb_per_s * climbed_m, -2.0, 2.0)}, state_of(truth));
    }
    jog.push_back({t_s, truth.velocity_world_mps.norm(), climbed_m,
                   flight_state(state_of(truth)).bank_rad / degree, -position.y()});
    aircraft.step(controls);
  }
  return jog;
}

/// After the jog, until the speed is within 0.5 m/s and the height within 0.3 m for good; nan: not yet.
double recovered_s(const std::vector<JogMoment>& jog) {
  double since_s = std::nan("");
  for (const JogMoment& now : jog) {
    const bool recovered = std::abs(now.speed_mps - jog_speed_mps) < 0.5 && std::abs(now.climbed_m) < 0.3 &&
                           now.t_s >= 2 * jog_half_s;
    if (!recovered)
      since_s = std::nan("");
    else if (std::isnan(since_s))
      since_s = now.t_s - 2 * jog_half_s;
  }
  return since_s;
}

std::string jog_picture(const std::vector<JogMoment>& jog) {
  std::vector<JogMoment> shown;
  for (std::size_t i = 0; i < jog.size(); i += 24) shown.push_back(jog[i]);
  const auto panel = [&](const char* title, const char* label, double JogMoment::*value) {
    LinePlot plot{title, "time (s)", label, {plotted("", shown, &JogMoment::t_s, value)}};
    plot.references = {{jog_half_s, "", true}, {2 * jog_half_s, "level asked", true}};
    return plot;
  };
  return to_svg({panel("Bank about the velocity", "bank (deg)", &JogMoment::bank_deg),
                 panel("Path", "to the right (m)", &JogMoment::aside_m),
                 panel("Speed", "speed (m/s)", &JogMoment::speed_mps),
                 panel("Height", "height (m)", &JogMoment::climbed_m)},
                2);
}

}  // namespace

Section dodge_section(const FreeFlight& air, const Airframe& airframe) {
  constexpr struct ComputedDodge {  // before [14]
    double speed_mps, near_m, near_late_m, far_m, far_late_m;
  } computed_dodges[] = {{9, 0.33, 0.15, 4.5, 3.3}, {10, 0.28, 0.11, 4.3, 2.9}, {12.3, 0.21, 0.05, 3.9, 2.3}};
  constexpr double late_s = 0.1;
  Section section{"dodge"};
  for (const ComputedDodge& computed : computed_dodges) {
    const double speed = computed.speed_mps;
    const auto reach = [&](double distance_m, double reaction_s, double cap_deg = 30,
                           double height_lost_m = 0.5) {
      return farthest_sideways_m(air, airframe,
                                 {speed, distance_m, reaction_s, 0.03, height_lost_m, cap_deg * degree});
    };
    const double near = reach(4.8, 0), near_late = reach(4.8, late_s);
    section.row("table", fmt::format("{:g} | {:.2f} / {:.2f} m | {:g} / {:g} m | {:.1f} / {:.1f} m | {:g} / "
                                     "{:g} m | {:.1f} m | {:.1f} m",
                                     speed, near, near_late, computed.near_m, computed.near_late_m,
                                     reach(10, 0), reach(10, late_s), computed.far_m, computed.far_late_m,
                                     reach(10, 0, 25), reach(10, 0, 30, 2)));
    section.checks.push_back(
        within(fmt::format("sideways within 4.8 m at {:g} m/s", speed), near, 0.03, computed.near_m, "m"));
    section.checks.push_back(
        within(fmt::format("the same {:g} s late", late_s), near_late, 0.03, computed.near_late_m, "m"));
  }
  const std::vector<JogMoment> jog = flown_jog(air, airframe);
  double slowest_mps = HUGE_VAL, lowest_m = HUGE_VAL;
  for (const JogMoment& now : jog) {
    slowest_mps = std::min(slowest_mps, now.speed_mps);
    lowest_m = std::min(lowest_m, now.climbed_m);
  }
  section.blocks.insert({{"speed_lost", fmt::format("{:.1f}", jog_speed_mps - slowest_mps)},
                         {"sunk", fmt::format("{:.1f}", -lowest_m)},
                         {"recovered", fmt::format("{:.1f}", recovered_s(jog))}});
  section.pictures["jog"] = jog_picture(jog);
  return section;
}

}  // namespace understory
