#include "tests/validation/trim_section.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "scenarios/report/line_plot.hpp"
#include "sim/aircraft/aerodynamics.hpp"
#include "tests/validation/page.hpp"

namespace understory {
namespace {

constexpr double degree = std::numbers::pi / 180;

// The identified model's own trim and limits (flight records of the original aircraft, 2014 to 2017).
constexpr double recorded_speed_mps = 12.27, recorded_attack_deg = 10.97, recorded_elevon_rad = 0.1914,
                 recorded_thrust_n = 5.08;
constexpr double recorded_slowest_mps = 8.0, recorded_fastest_mps = 12.8;
constexpr double slowest_attack_rad = 25 * degree;  // where the records end level flight: a real wing stalls

/// The flattest straight flight at this speed: level, or where the motor is too weak the shallowest descent.
std::optional<Trim> flattest_trim(const Airframe& airframe, double speed_mps) {
  if (const std::optional<Trim> level = straight_trim(airframe, speed_mps)) return level;
  double steep = -0.6, flat = 0;  // flies at `steep`, not at `flat`
  if (!straight_trim(airframe, speed_mps, steep)) return std::nullopt;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (steep + flat);
    (straight_trim(airframe, speed_mps, middle) ? steep : flat) = middle;
  }
  return straight_trim(airframe, speed_mps, steep);
}

/// The end of level flight between two speeds of which one flies level and the other does not.
double limit_speed_mps(const Airframe& airframe, double flies_mps, double does_not_mps,
                       double maximum_attack_rad) {
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (flies_mps + does_not_mps);
    (straight_trim(airframe, middle, 0, maximum_attack_rad) ? flies_mps : does_not_mps) = middle;
  }
  return flies_mps;
}

struct TrimCurve {
  std::vector<double> speed, attack_deg, elevon_deg, thrust, descent_deg;
};

TrimCurve trim_curve(const Airframe& airframe, double from_mps, double to_mps) {
  TrimCurve curve;
  for (double speed = from_mps; speed < to_mps + 1e-9; speed += 0.2) {
    const std::optional<Trim> trim = flattest_trim(airframe, speed);
    if (!trim) continue;
    curve.speed.push_back(speed);
    curve.attack_deg.push_back(trim->angle_of_attack_rad / degree);
    curve.elevon_deg.push_back(trim->elevon_rad / degree);
    curve.thrust.push_back(trim->thrust_n);
    curve.descent_deg.push_back(-trim->climb_angle_rad / degree);
  }
  return curve;
}

Figure trim_figure(const Airframe& airframe, double slowest_mps, double fastest_mps) {
  const TrimCurve level = trim_curve(airframe, slowest_mps, fastest_mps);
  const TrimCurve descending = trim_curve(airframe, fastest_mps, 16);
  const auto panel = [&](const char* title, const char* label, std::vector<double> TrimCurve::*values,
                         double recorded) {
    LinePlot plot{title, "airspeed (m/s)", label, {}, {}, {}, {}};
    plot.series = {{"level", level.speed, level.*values},
                   {"descending, all the thrust", descending.speed, descending.*values, Mark::dashes, 0},
                   {"flight records", {recorded_speed_mps}, {recorded}, Mark::dots, 1}};
    plot.references = {{recorded_slowest_mps, "8.0", true}, {recorded_fastest_mps, "12.8", true}};
    return plot;
  };
  std::vector<LinePlot> panels{
      panel("Angle of attack", "angle of attack (deg)", &TrimCurve::attack_deg, recorded_attack_deg),
      panel("Elevons", "both elevons, trailing edge up (deg)", &TrimCurve::elevon_deg,
            recorded_elevon_rad / degree),
      panel("Thrust", "thrust (N)", &TrimCurve::thrust, recorded_thrust_n)};
  panels.back().references.push_back({airframe.max_thrust_n, "5.34 N: all there is"});
  LinePlot descent{"Path", "airspeed (m/s)", "descent angle (deg)", {}, panels[0].references, {}, {}};
  descent.series = {
      {"level", level.speed, level.descent_deg},
      {"descending, all the thrust", descending.speed, descending.descent_deg, Mark::dashes, 0}};
  panels.push_back(descent);
  return {"trim", "Straight flight with the wings level; vertical lines: the records' limits of level flight",
          to_svg(panels, 2)};
}

}  // namespace

Section trim_section(const Airframe& airframe) {
  Section section;
  section.title = "Trim";
  const double slowest = limit_speed_mps(airframe, 11, 6, slowest_attack_rad);
  const double fastest = limit_speed_mps(airframe, 11, 16, slowest_attack_rad);
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  const Trim trim = straight_trim(airframe, recorded_speed_mps)
                        .value_or(Trim{recorded_speed_mps, 0, nothing, nothing, nothing});
  std::vector<std::vector<std::string>> rows;
  for (const double speed : {8.0, 9.0, 10.0, 11.0, 12.0, 12.27, 12.8, 14.0, 16.0}) {
    const std::optional<Trim> at = flattest_trim(airframe, speed);
    if (!at) continue;
    rows.push_back({fmt::format("{:g}", speed), fmt::format("{:.2f}", at->angle_of_attack_rad / degree),
                    fmt::format("{:.4f}", at->elevon_rad), fmt::format("{:.2f}", at->thrust_n),
                    at->climb_angle_rad < 0
                        ? fmt::format("descends {:.1f} deg", -at->climb_angle_rad / degree)
                        : "level"});
  }
  section.markdown =
      fmt::format(
          "Newton's method on the three longitudinal equations (`sim/aircraft/trim`). Level flight reaches "
          "from "
          "{:.2f} m/s, where the angle of attack comes to 25 deg, to {:.2f} m/s, where the motor gives all "
          "it has; faster only descending.\n\n",
          slowest, fastest) +
      markdown_table({"airspeed (m/s)", "angle of attack (deg)", "elevons (rad)", "thrust (N)", "path"},
                     rows);
  section.figures = {trim_figure(airframe, slowest, fastest)};
  // 1 %: the records give three digits. The limits of level flight they give to 0.1 m/s, "about".
  section.checks = {within("angle of attack at 12.27 m/s", trim.angle_of_attack_rad / degree, 0.11,
                           recorded_attack_deg, "deg"),
                    within("elevons at 12.27 m/s", trim.elevon_rad, 0.002, recorded_elevon_rad, "rad"),
                    within("thrust at 12.27 m/s", trim.thrust_n, 0.05, recorded_thrust_n, "N"),
                    within("slowest level flight", slowest, 0.1, recorded_slowest_mps, "m/s"),
                    within("fastest level flight", fastest, 0.1, recorded_fastest_mps, "m/s")};
  return section;
}

}  // namespace understory
