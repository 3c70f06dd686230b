#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/aircraft/aerodynamics.hpp"
#include "tests/validation/flight_mechanics.hpp"
#include "tests/validation/sections.hpp"

/// Trim, turns and glide: what steady flight says.
namespace understory {
namespace {

// The identified model's own trim and limits [3].
constexpr double recorded_speed_mps = 12.27, recorded_attack_deg = 10.97, recorded_elevon_rad = 0.1914,
                 recorded_thrust_n = 5.08;
constexpr double recorded_slowest_mps = 8.0, recorded_fastest_mps = 12.8;
constexpr double slowest_attack_rad = 25 * degree;  // where the records end level flight: a real wing stalls

/// The flattest straight flight at this speed: level, or where the motor is too weak with all the thrust.
std::optional<SteadyFlight> flattest_flight(const Airframe& airframe, double speed_mps) {
  SteadyFlight given;
  given.airspeed_mps = speed_mps;
  const std::optional<SteadyFlight> level = steady_flight(airframe, given, Solved::thrust);
  if (level && level->thrust_n <= airframe.max_thrust_n) return level;
  given.thrust_n = airframe.max_thrust_n;
  return steady_flight(airframe, given, Solved::climb_angle);
}

std::vector<SteadyFlight> flattest_flights(const Airframe& airframe, double from_mps, double to_mps) {
  std::vector<SteadyFlight> flights;
  for (double speed = from_mps; speed < to_mps + 1e-9; speed += 0.2)
    if (const auto flight = flattest_flight(airframe, speed)) flights.push_back(*flight);
  return flights;
}

std::string trim_picture(const Airframe& airframe, double slowest_mps, double fastest_mps) {
  const std::vector<SteadyFlight> level = flattest_flights(airframe, slowest_mps, fastest_mps),
                                  descending = flattest_flights(airframe, fastest_mps, 16);
  const auto panel = [&](const char* title, const char* label, double (*value)(const SteadyFlight&),
                         std::vector<double> recorded) {
    LinePlot plot{title, "airspeed (m/s)", label};
    plot.series = {plotted("level", level, &SteadyFlight::airspeed_mps, value),
                   plotted("descending, all the thrust", descending, &SteadyFlight::airspeed_mps, value,
                           Mark::dashes, 0)};
    if (!recorded.empty())
      plot.series.push_back({"flight records", {recorded_speed_mps}, recorded, Mark::dots, 1});
    plot.references = {{recorded_slowest_mps, "8.0", true}, {recorded_fastest_mps, "12.8", true}};
    return plot;
  };
  std::vector<LinePlot> panels{
      panel("Angle of attack", "angle of attack (deg)",
            [](const SteadyFlight& trim) { return trim.angle_of_attack_rad / degree; },
            {recorded_attack_deg}),
      panel("Elevons", "both elevons, trailing edge up (deg)",
            [](const SteadyFlight& trim) { return trim.left_elevon_rad / degree; },
            {recorded_elevon_rad / degree}),
      panel("Thrust", "thrust (N)", [](const SteadyFlight& trim) { return trim.thrust_n; },
            {recorded_thrust_n}),
      panel("Path", "descent angle (deg)",
            [](const SteadyFlight& trim) { return -trim.climb_angle_rad / degree; }, {})};
  panels[2].references.push_back(
      {airframe.max_thrust_n, fmt::format("{:g} N: all there is", airframe.max_thrust_n)});
  return to_svg(panels, 2);
}

constexpr double attack_cap_rad = 30 * degree;

/// Computed before, of the aircraft without pitch damping [14].
constexpr struct ComputedTurn {
  double speed_mps, bank_deg, radius_m, load_factor;
} computed_turns[] = {{9, 40, 9.7, 1.5}, {10, 41, 12, 1.75}, {12.3, 26, 32, 2.4}};

SteadyFlight sustained_turn(const Airframe& airframe, double speed_mps) {
  return steepest_turn(airframe, speed_mps, 0, attack_cap_rad);
}

double bank_deg(const SteadyFlight& flight) { return flight.bank_rad / degree; }

Airframe without_pitch_damping(Airframe airframe) {
  airframe.rate_damping_nmspr.y() = 0;
  return airframe;
}

/// The bank that holds its speed, over speed.
LinePlot sustained_panel(const Airframe& airframe) {
  const auto held = [](const Airframe& of) {
    std::vector<SteadyFlight> turns;
    for (double speed = 8; speed < 12.8; speed += 0.1) turns.push_back(sustained_turn(of, speed));
    return turns;
  };
  LinePlot plot{"Bank that holds its speed", "airspeed (m/s)", "bank (deg)"};
  plot.series = {plotted("full aircraft", held(airframe), &SteadyFlight::airspeed_mps, bank_deg),
                 plotted("without pitch damping", held(without_pitch_damping(airframe)),
                         &SteadyFlight::airspeed_mps, bank_deg, Mark::dashes),
                 plotted("computed [14]", computed_turns, &ComputedTurn::speed_mps, &ComputedTurn::bank_deg,
                         Mark::dots, 3)};
  return plot;
}

std::string turn_picture(const Airframe& airframe) {
  LinePlot radius{"Turn radius, level", "bank (deg)", "radius (m)"};
  LinePlot load{"Load factor, level", "bank (deg)", "lift over weight"};
  LinePlot loss{"Speed gained or lost, level, all the thrust", "bank (deg)", "acceleration (m/s²)"};
  int colour = 0;
  for (const ComputedTurn& computed : computed_turns) {
    std::vector<SteadyFlight> turns;
    for (double bank = 2; bank < 75; bank += 1) {
      const std::optional<SteadyFlight> turn =
          full_thrust_turn(airframe, computed.speed_mps, bank * degree, attack_cap_rad);
      if (!turn) break;
      turns.push_back(*turn);
    }
    const std::string name = fmt::format("{:g} m/s", computed.speed_mps);
    radius.series.push_back(plotted(name, turns, bank_deg, &SteadyFlight::radius_m, Mark::line, colour));
    load.series.push_back(plotted(name, turns, bank_deg, &SteadyFlight::load_factor, Mark::line, colour));
    loss.series.push_back(
        plotted(name, turns, bank_deg, &SteadyFlight::acceleration_mps2, Mark::line, colour));
    ++colour;
  }
  std::vector<double> banks_deg;
  for (double bank = 0; bank <= 62; bank += 2) banks_deg.push_back(bank);
  load.series.push_back(plotted(
      "1 / cos(bank)", banks_deg, [](double bank) { return bank; },
      [](double bank) { return 1 / std::cos(bank * degree); }, Mark::dashes, 7));
  radius.y_range = AxisRange{0, 60};
  radius.series.push_back(plotted("sustained, computed [14]", computed_turns, &ComputedTurn::bank_deg,
                                  &ComputedTurn::radius_m, Mark::dots, 3));
  loss.references = {{0, "holds its speed"}};
  return to_svg({radius, load, loss, sustained_panel(airframe)}, 2);
}

double sink_mps(const SteadyFlight& glide) { return glide.sink_mps(); }
double glide_ratio(const SteadyFlight& glide) { return 1 / std::tan(-glide.climb_angle_rad); }

}  // namespace

Section trim_section(const Airframe& airframe) {
  Section section{"trim"};
  const auto flies_level = [&](double speed_mps) {
    return straight_trim(airframe, speed_mps, 0, slowest_attack_rad).has_value();
  };
  const double slowest = border(11, 6, flies_level), fastest = border(11, 16, flies_level);
  section.blocks.insert(
      {{"slowest", fmt::format("{:.2f}", slowest)}, {"fastest", fmt::format("{:.2f}", fastest)}});
  for (const double speed : {8.0, 9.0, 10.0, 11.0, 12.0, 12.27, 12.8, 14.0, 16.0}) {
    const std::optional<SteadyFlight> at = flattest_flight(airframe, speed);
    if (!at) continue;
    section.row("table", fmt::format("{:g} | {:.2f} | {:.4f} | {:.2f} | {}", speed,
                                     at->angle_of_attack_rad / degree, at->left_elevon_rad, at->thrust_n,
                                     at->climb_angle_rad < 0
                                         ? fmt::format("descends {:.1f} deg", -at->climb_angle_rad / degree)
                                         : "level"));
  }
  section.pictures["trim"] = trim_picture(airframe, slowest, fastest);
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  const Trim trim =
      straight_trim(airframe, recorded_speed_mps).value_or(Trim{0, 0, nothing, nothing, nothing});
  // 1 %: the records give three digits. The limits of level flight they give to 0.1 m/s, "about".
  section.checks = {within("angle of attack at 12.27 m/s", trim.angle_of_attack_rad / degree, 0.11,
                           recorded_attack_deg, "deg"),
                    within("elevons at 12.27 m/s", trim.elevon_rad, 0.002, recorded_elevon_rad, "rad"),
                    within("thrust at 12.27 m/s", trim.thrust_n, 0.05, recorded_thrust_n, "N"),
                    within("slowest level flight", slowest, 0.1, recorded_slowest_mps, "m/s"),
                    within("fastest level flight", fastest, 0.1, recorded_fastest_mps, "m/s")};
  return section;
}

Section turn_section(const Airframe& airframe) {
  const Airframe undamped = without_pitch_damping(airframe);  // no elevons needed against it
  Section section{"turn"};
  AxisRange bank_lost{HUGE_VAL, -HUGE_VAL}, load_lost = bank_lost;
  for (const ComputedTurn& computed : computed_turns) {
    const double speed = computed.speed_mps;
    const SteadyFlight held = sustained_turn(airframe, speed), free = sustained_turn(undamped, speed),
                       hard = hardest_turn(airframe, speed, attack_cap_rad),
                       hard_free = hardest_turn(undamped, speed, attack_cap_rad);
    include(bank_lost, bank_deg(free) - bank_deg(held));
    include(load_lost, 100 * (1 - hard.load_factor / hard_free.load_factor));
    section.row("table", fmt::format("{:g} | {:.1f} deg ({:.1f} m) | {:.1f} deg ({:.1f} m) | {:g} deg ({:g} "
                                     "m) | {:.2f} | {:.2f} | {:g}",
                                     speed, bank_deg(held), held.radius_m(), bank_deg(free), free.radius_m(),
                                     computed.bank_deg, computed.radius_m, hard.load_factor,
                                     hard_free.load_factor, computed.load_factor));
    // The computed figures have two digits or three; bank and radius at 9 m/s agree to 1 deg.
    const std::string at = fmt::format(" at {:g} m/s, no pitch damping", speed);
    section.checks.push_back(within("sustained bank" + at, bank_deg(free), 1.5, computed.bank_deg, "deg"));
    section.checks.push_back(within("its radius" + at, free.radius_m(), 0.5, computed.radius_m, "m"));
    section.checks.push_back(within("load factor at 30 deg of angle of attack" + at, hard_free.load_factor,
                                    0.05, computed.load_factor, ""));
  }
  const auto range = [](const AxisRange& of) {
    return fmt::format("{:.0f} to {:.0f}", of.minimum, of.maximum);
  };
  section.blocks.insert({{"bank_lost", range(bank_lost)}, {"load_lost", range(load_lost)}});
  section.pictures["turn"] = turn_picture(airframe);
  return section;
}

Section glide_section(const Airframe& airframe) {
  std::vector<SteadyFlight> glides;
  for (double speed = 7.5; speed < 15.01; speed += 0.1) {
    SteadyFlight given;
    given.airspeed_mps = speed;
    given.climb_angle_rad = -0.5;
    if (const auto glide = steady_flight(airframe, given, Solved::climb_angle)) glides.push_back(*glide);
  }
  const auto point_mass_sink_mps = [&](const SteadyFlight& glide) {
    const double speed = glide.airspeed_mps, pressure_area = 0.5 * airframe.air_density_kgpm3 * speed * speed;
    const double sine = std::sin(glide.angle_of_attack_rad), cosine = std::cos(glide.angle_of_attack_rad);
    const double drag_n = pressure_area * (2 * airframe.wing_area_m2 * sine * sine +
                                           airframe.body_drag_area_m2 * cosine * cosine * cosine);
    return speed * drag_n / (airframe.mass_kg * airframe.gravity_mps2);
  };
  LinePlot polar{"Glide polar", "airspeed (m/s)", "sink (m/s)"};
  polar.series = {plotted("trimmed, elevons included", glides, &SteadyFlight::airspeed_mps, sink_mps),
                  plotted("lift and drag of wing and body alone", glides, &SteadyFlight::airspeed_mps,
                          point_mass_sink_mps, Mark::dashes)};
  polar.y_range = AxisRange{0, 15};
  LinePlot attacks{"Angle of attack in the glide", "airspeed (m/s)", "angle of attack (deg)"};
  attacks.series = {plotted("trimmed, elevons included", glides, &SteadyFlight::airspeed_mps,
                            [](const SteadyFlight& glide) { return glide.angle_of_attack_rad / degree; })};
  attacks.references = {{25, "25 deg: a real wing stalls about here"}};
  const auto less = [](auto value) {
    return [value](const SteadyFlight& a, const SteadyFlight& b) { return value(a) < value(b); };
  };
  const SteadyFlight slowest_sink = *std::min_element(glides.begin(), glides.end(), less(sink_mps)),
                     flattest = *std::max_element(glides.begin(), glides.end(), less(glide_ratio));
  Section section{"glide"};
  section.blocks.insert({{"ratio", fmt::format("{:.2f}", glide_ratio(flattest))},
                         {"ratio_speed", fmt::format("{:.1f}", flattest.airspeed_mps)},
                         {"sink", fmt::format("{:.2f}", sink_mps(slowest_sink))},
                         {"sink_speed", fmt::format("{:.1f}", slowest_sink.airspeed_mps)}});
  section.pictures["glide"] = to_svg({polar, attacks}, 2);
  return section;
}

}  // namespace understory
