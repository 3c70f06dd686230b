#include <fmt/format.h>

#include <cmath>

#include "planning/flight_model.hpp"
#include "scenarios/parts/oracles.hpp"
#include "sim/aircraft/aerodynamics.hpp"
#include "tests/validation/sections.hpp"

namespace understory {
namespace {

constexpr double servo_lag_s = 0.030;  // what [14] counts with; the simulator's elevons have none by default

struct Roll {
  double speed_mps = 0;
  double time_s = HUGE_VAL;  ///< from level flight to 60 deg of bank
  double rate_degps = 0;     ///< that the deflections hold
};

/// With the mean at trim and the lag [14].
constexpr Roll computed_rolls[] = {{9, 0.43, 222}, {10, 0.39, 296}, {12.3, 0.35, 468}};

/// The rate about body x at which these deflections make no more roll moment, angle of attack and speed held.
double steady_rate_degps(const Airframe& airframe, const AirborneStart& start, double left_rad,
                         double right_rad) {
  AirState air;
  air.air_velocity_body_mps = start.velocity_body_mps;
  air.left_elevon_rad = left_rad;
  air.right_elevon_rad = right_rad;
  double slow = 0, fast = 30;  // rad/s: rolls faster, rolls slower
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (slow + fast);
    air.angular_rate_body_radps = {middle, 0, 0};
    (aerodynamic_wrench(airframe, air).moment_body_nm.x() > 0 ? slow : fast) = middle;
  }
  return slow / degree;
}

/// Who flies, how fast, and how the elevons lag behind.
struct RollTask {
  const FreeFlight& air;
  const Airframe& airframe;
  double speed_mps;
  double lag_s;
};

/// From level trim both elevons are told where to go and stay there: right wing down.
Roll roll(const RollTask& task, const AirborneStart& start, double left_rad, double right_rad) {
  constexpr double longest_s = 1.2, wanted_bank_rad = 60 * degree;
  Aircraft aircraft = task.air.begin(task.airframe, start);
  Controls controls = start.controls;
  controls.thrust_n = task.airframe.max_thrust_n;
  const double share = task.lag_s > 0 ? 1 - std::exp(-1.0 / (physics_rate_hz * task.lag_s)) : 1;
  Roll result{task.speed_mps, HUGE_VAL, steady_rate_degps(task.airframe, start, left_rad, right_rad)};
  for (int step = 1; step < longest_s * physics_rate_hz && result.time_s == HUGE_VAL; ++step) {
    controls.left_elevon_rad += share * (left_rad - controls.left_elevon_rad);
    controls.right_elevon_rad += share * (right_rad - controls.right_elevon_rad);
    aircraft.step(controls);
    if (flight_state(state_of(aircraft.truth())).bank_rad >= wanted_bank_rad)
      result.time_s = static_cast<double>(step) / physics_rate_hz;
  }
  return result;
}

/// The pair of deflections, of a grid, that banks to 60 deg soonest.
Roll fastest_roll(const RollTask& task) {
  const AirborneStart start = trimmed_start(task.airframe, task.speed_mps);
  constexpr int steps = 8;
  Roll best;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      const Roll tried = roll(task, start, task.airframe.elevon_min_rad * i / steps,
                              task.airframe.elevon_max_rad * j / steps);
      if (tried.time_s < best.time_s) best = tried;
    }
  }
  return best;
}

/// The elevons' mean stays where trim has it, and the upper one goes to its stop.
Roll symmetric_roll(const RollTask& task) {
  const AirborneStart start = trimmed_start(task.airframe, task.speed_mps);
  const double mean = start.controls.left_elevon_rad, room = task.airframe.elevon_max_rad - mean;
  return roll(task, start, mean - room, mean + room);
}

std::string roll_picture(const FreeFlight& air, const Airframe& airframe) {
  std::vector<Roll> plain, lagged, even;
  for (double speed = 8; speed < 12.8; speed += 0.5) {
    plain.push_back(fastest_roll({air, airframe, speed, 0}));
    lagged.push_back(fastest_roll({air, airframe, speed, servo_lag_s}));
    even.push_back(symmetric_roll({air, airframe, speed, servo_lag_s}));
  }
  LinePlot time{"Time to 60 deg of bank", "airspeed (m/s)", "time (s)"};
  time.series = {plotted("best pair", plain, &Roll::speed_mps, &Roll::time_s),
                 plotted("best pair, 30 ms servo lag", lagged, &Roll::speed_mps, &Roll::time_s),
                 plotted("mean at trim, 30 ms lag", even, &Roll::speed_mps, &Roll::time_s),
                 plotted("computed [14]", computed_rolls, &Roll::speed_mps, &Roll::time_s, Mark::dots, 3)};
  time.y_range = AxisRange{0, 0.7};
  LinePlot rate{"Steady roll rate", "airspeed (m/s)", "roll rate (deg/s)"};
  rate.series = {
      plotted("best pair", plain, &Roll::speed_mps, &Roll::rate_degps),
      plotted("mean at trim, 30 ms lag", even, &Roll::speed_mps, &Roll::rate_degps, Mark::line, 2),
      plotted("computed [14]", computed_rolls, &Roll::speed_mps, &Roll::rate_degps, Mark::dots, 3)};
  rate.y_range = AxisRange{0, 700};
  return to_svg({time, rate}, 2);
}

}  // namespace

Section roll_section(const FreeFlight& air, const Airframe& airframe) {
  Section section{"roll"};
  AxisRange faster{HUGE_VAL, -HUGE_VAL};
  for (const Roll& computed : computed_rolls) {
    const double speed = computed.speed_mps;
    const Roll plain = fastest_roll({air, airframe, speed, 0}),
               lagged = fastest_roll({air, airframe, speed, servo_lag_s}),
               even = symmetric_roll({air, airframe, speed, servo_lag_s});
    include(faster, 100 * (plain.rate_degps / even.rate_degps - 1));
    section.row("table", fmt::format("{:g} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.0f} | {:.0f} | {:g}",
                                     speed, plain.time_s, lagged.time_s, even.time_s, computed.time_s,
                                     plain.rate_degps, even.rate_degps, computed.rate_degps));
    section.checks.push_back(within(fmt::format("steady roll rate at {:g} m/s, mean at trim", speed),
                                    even.rate_degps, 0.05 * computed.rate_degps, computed.rate_degps,
                                    "deg/s"));
    section.blocks["early"] =
        fmt::format("{:.2f}", computed.time_s - even.time_s);  // of the fastest, the last
    section.blocks["time"] = fmt::format("{:.2f}", even.time_s);
    section.blocks["rate"] = fmt::format("{:.0f}", even.rate_degps);
  }
  section.blocks["faster"] = fmt::format("{:.0f} to {:.0f}", faster.minimum, faster.maximum);
  section.pictures["roll"] = roll_picture(air, airframe);
  return section;
}

}  // namespace understory
