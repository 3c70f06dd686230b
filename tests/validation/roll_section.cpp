#include "tests/validation/roll_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planning/flight_model.hpp"
#include "scenarios/flight/oracles.hpp"
#include "scenarios/report/line_plot.hpp"
#include "sim/aircraft/aerodynamics.hpp"
#include "tests/validation/page.hpp"

namespace understory {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double wanted_bank_rad = 60 * degree;
constexpr double servo_lag_s =
    0.030;  // what FACTS section 3 counted with; the simulator's elevons have no lag

struct Roll {
  double time_to_60_s = HUGE_VAL;
  double left_elevon_rad = 0;
  double right_elevon_rad = 0;
};

/// From level trim both elevons are told where to go and stay there: right wing down.
Roll roll(const FreeFlight& air, const Airframe& airframe, const AirborneStart& start, double left_rad,
          double right_rad, double lag_s) {
  constexpr double longest_s = 1.2;
  Aircraft aircraft = air.begin(airframe, start);
  Roll result{HUGE_VAL, left_rad, right_rad};
  Controls controls = start.controls;
  controls.thrust_n = airframe.max_thrust_n;
  const double share = lag_s > 0 ? 1 - std::exp(-1.0 / (physics_rate_hz * lag_s)) : 1;
  for (int step = 1; step < longest_s * physics_rate_hz; ++step) {
    controls.left_elevon_rad += share * (left_rad - controls.left_elevon_rad);
    controls.right_elevon_rad += share * (right_rad - controls.right_elevon_rad);
    aircraft.step(controls);
    if (flight_state(state_of(aircraft.truth())).bank_rad < wanted_bank_rad) continue;
    result.time_to_60_s = static_cast<double>(step) / physics_rate_hz;
    return result;
  }
  return result;
}

/// The pair of deflections that banks to 60 deg soonest.
Roll fastest_roll(const FreeFlight& air, const Airframe& airframe, double speed_mps, double lag_s) {
  const AirborneStart start = trimmed_start(airframe, speed_mps);
  constexpr int steps = 8;
  Roll best;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      const double left = airframe.elevon_min_rad * i / steps;
      const double right = airframe.elevon_max_rad * j / steps;
      const Roll tried = roll(air, airframe, start, left, right, lag_s);
      if (tried.time_to_60_s < best.time_to_60_s) best = tried;
    }
  }
  return best;
}

/// The elevons' mean stays where trim has it, and the upper one goes to its stop.
Roll symmetric_roll(const FreeFlight& air, const Airframe& airframe, double speed_mps, double lag_s) {
  const AirborneStart start = trimmed_start(airframe, speed_mps);
  const double mean = start.controls.left_elevon_rad;
  const double room = airframe.elevon_max_rad - mean;
  return roll(air, airframe, start, mean - room, mean + room, lag_s);
}

/// The rate about body x at which these deflections make no more roll moment, angle of attack and speed held.
double steady_roll_rate_radps(const Airframe& airframe, const AirborneStart& start, double left_rad,
                              double right_rad) {
  AirState air;
  air.air_velocity_body_mps = start.velocity_body_mps;
  air.left_elevon_rad = left_rad;
  air.right_elevon_rad = right_rad;
  double slow = 0, fast = 30;  // rolls faster, rolls slower
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (slow + fast);
    air.angular_rate_body_radps = {middle, 0, 0};
    (aerodynamic_wrench(airframe, air).moment_body_nm.x() > 0 ? slow : fast) = middle;
  }
  return slow;
}

double steady_rate_degps(const Airframe& airframe, double speed_mps, const Roll& roll) {
  return steady_roll_rate_radps(airframe, trimmed_start(airframe, speed_mps), roll.left_elevon_rad,
                                roll.right_elevon_rad) /
         degree;
}

using AnyRoll = Roll (*)(const FreeFlight&, const Airframe&, double, double);

struct RollCurve {
  Series time, rate;
};

RollCurve roll_curve(const FreeFlight& air, const Airframe& airframe, AnyRoll kind, double lag_s,
                     const std::string& name) {
  RollCurve curve{{name}, {name}};
  for (double speed = 8; speed < 12.8; speed += 0.5) {
    const Roll best = kind(air, airframe, speed, lag_s);
    for (Series* series : {&curve.time, &curve.rate}) series->x.push_back(speed);
    curve.time.y.push_back(best.time_to_60_s);
    curve.rate.y.push_back(steady_rate_degps(airframe, speed, best));
  }
  return curve;
}

}  // namespace

Section roll_section(const FreeFlight& air, const Airframe& airframe) {
  struct Facts {
    double speed_mps, rate_degps, time_s;
  };
  const Facts facts[] = {{9, 222, 0.43}, {10, 296, 0.39}, {12.3, 468, 0.35}};
  Section section;
  section.title = "Roll";
  std::vector<std::vector<std::string>> rows;
  for (const Facts& fact : facts) {
    const double speed = fact.speed_mps;
    const Roll plain = fastest_roll(air, airframe, speed, 0),
               lagged = fastest_roll(air, airframe, speed, servo_lag_s),
               even = symmetric_roll(air, airframe, speed, servo_lag_s);
    const double even_rate = steady_rate_degps(airframe, speed, even);
    rows.push_back({fmt::format("{:g}", speed), fmt::format("{:.2f}", plain.time_to_60_s),
                    fmt::format("{:.2f}", lagged.time_to_60_s), fmt::format("{:.2f}", even.time_to_60_s),
                    fmt::format("{:.2f}", fact.time_s),
                    fmt::format("{:.0f}", steady_rate_degps(airframe, speed, plain)),
                    fmt::format("{:.0f}", even_rate), fmt::format("{:g}", fact.rate_degps)});
    section.checks.push_back(within(fmt::format("steady roll rate at {:g} m/s, mean at trim", speed),
                                    even_rate, 0.05 * fact.rate_degps, fact.rate_degps, "deg/s"));
  }
  section.markdown =
      "From level trim both elevons are sent to fixed deflections and reach them after the input delay of "
      "20 ms. Best pair: that of a 9 by 9 grid which banks to 60 deg soonest. Mean at trim: one elevon up "
      "to its stop, the other as far down. The steady rate is where the roll moment vanishes at the trim's "
      "speed and angle of attack.\n\n" +
      markdown_table(
          {"airspeed (m/s)", "to 60 deg, best pair (s)", "with a 30 ms servo lag",
           "mean at trim, with the lag", "FACTS", "steady rate, best pair (deg/s)", "mean at trim", "FACTS"},
          rows) +
      "\n"
      "FACTS' rates are those with the mean at trim, within 5 %; letting the mean go is 9 to 19 % faster. "
      "FACTS' time at 9 m/s is met too. At 12.3 m/s the simulated aircraft is 0.06 s faster than FACTS "
      "says, which its text does not explain: 0.29 s is what 20 ms of delay, 30 ms of lag and a roll time "
      "constant of 0.14 s (see the modes) make of 488 deg/s.\n";
  const RollCurve plain = roll_curve(air, airframe, fastest_roll, 0, "best pair"),
                  lagged = roll_curve(air, airframe, fastest_roll, servo_lag_s, "best pair, 30 ms servo lag"),
                  even = roll_curve(air, airframe, symmetric_roll, servo_lag_s, "mean at trim, 30 ms lag");
  LinePlot time{"Time to 60 deg of bank", "airspeed (m/s)", "time (s)"};
  time.series = {
      plain.time, lagged.time, even.time, {"FACTS", {9, 10, 12.3}, {0.43, 0.39, 0.35}, Mark::dots, 3}};
  time.y_range = AxisRange{0, 0.7};
  LinePlot rate{"Steady roll rate", "airspeed (m/s)", "roll rate (deg/s)"};
  rate.series = {plain.rate, even.rate, {"FACTS", {9, 10, 12.3}, {222, 296, 468}, Mark::dots, 3}};
  rate.series[1].colour = 2;
  rate.y_range = AxisRange{0, 700};
  section.figures = {{"roll", "Rolling from level flight", to_svg({time, rate}, 2)}};
  return section;
}

}  // namespace understory
