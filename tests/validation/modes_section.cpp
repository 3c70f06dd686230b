#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/validation/flight_mechanics.hpp"
#include "tests/validation/sections.hpp"

namespace understory {
namespace {

/// Level flight at one speed.
struct LevelModes {
  double speed_mps;
  Modes found;
};

std::optional<LevelModes> level_modes(const Airframe& airframe, double speed_mps) {
  SteadyFlight given;
  given.airspeed_mps = speed_mps;
  const std::optional<SteadyFlight> trim = steady_flight(airframe, given, Solved::thrust);
  if (!trim) return std::nullopt;
  return LevelModes{speed_mps, modes(airframe, *trim)};
}

double real_part(const Mode& mode) { return mode.eigenvalue.real(); }
double imaginary_part(const Mode& mode) { return mode.eigenvalue.imag(); }

/// The value of the mode called `name` over speed.
Series mode_series(const std::vector<LevelModes>& all, const std::string& name, double (*value)(const Mode&),
                   int colour) {
  return plotted(
      name, all, &LevelModes::speed_mps,
      [&](const LevelModes& at) {
        for (const std::vector<Mode>* set : {&at.found.longitudinal, &at.found.lateral})
          for (const Mode& mode : *set)
            if (mode.name == name) return value(mode);
        return std::nan("");
      },
      Mark::line, colour);
}

using NamesAndColours = std::vector<std::pair<const char*, int>>;

std::string modes_picture(const Airframe& airframe) {
  std::vector<LevelModes> all;
  for (double speed = 8; speed < 12.7 + 1e-9; speed += 0.1)
    if (const auto at = level_modes(airframe, speed)) all.push_back(*at);
  const auto panel = [&](const char* title, const char* label, const NamesAndColours& names,
                         double (*value)(const Mode&)) {
    LinePlot plot{title, "airspeed (m/s)", label};
    for (const auto& [name, colour] : names) plot.series.push_back(mode_series(all, name, value, colour));
    plot.references = {{0}};
    return plot;
  };
  return to_svg(
      {panel("Longitudinal: how fast it dies out", "real part (1/s)",
             {{"short period", 0},
              {"short period, fast part", 1},
              {"short period, slow part", 2},
              {"phugoid", 3}},
             real_part),
       panel("Lateral: how fast it dies out", "real part (1/s)",
             {{"roll subsidence", 0}, {"dutch roll", 1}, {"spiral", 2}}, real_part),
       panel("Longitudinal: how fast it swings", "imaginary part (rad/s)",
             {{"short period", 0}, {"phugoid", 3}}, imaginary_part),
       panel("Lateral: how fast it swings", "imaginary part (rad/s)", {{"dutch roll", 1}}, imaginary_part)},
      2);
}

double doubling_time_s(const Mode& mode) { return std::log(2.0) / mode.eigenvalue.real(); }

std::string text_of(const Mode& mode) {
  if (mode.swings())
    return fmt::format("{:.2f} rad/s, damping {:.2f}", mode.frequency_radps(), mode.damping());
  if (mode.eigenvalue.real() > 0) return fmt::format("grows, doubles in {:.1f} s", doubling_time_s(mode));
  return fmt::format("dies out, time constant {:.2f} s", mode.time_constant_s());
}

/// A name's modes together: an overdamped short period has two.
std::string text_of(const std::vector<Mode>& set, const std::string& name) {
  std::string text;
  for (const Mode& mode : set)
    if (mode.name.starts_with(name)) text += (text.empty() ? "" : "; ") + text_of(mode);
  return text;
}

}  // namespace

Section modes_section(const Airframe& airframe) {
  Section section{"modes"};
  double worst_coupling = 0;
  bool others_die_out = true;
  for (const double speed : {8.0, 9.0, 10.0, 11.0, 12.27, 12.7}) {
    const std::optional<LevelModes> at = level_modes(airframe, speed);
    if (!at) continue;
    const auto& [longitudinal, lateral, coupling] = at->found;
    worst_coupling = std::max(worst_coupling, coupling);
    for (const std::vector<Mode>* set : {&longitudinal, &lateral})
      for (const Mode& mode : *set)
        others_die_out = others_die_out && (mode.name == "spiral" || mode.eigenvalue.real() < 0);
    section.row("table",
                fmt::format("{:g} | {} | {} | {} | {} | {}", speed, text_of(longitudinal, "short period"),
                            text_of(longitudinal, "phugoid"), text_of(lateral, "roll subsidence"),
                            text_of(lateral, "dutch roll"), text_of(lateral, "spiral")));
    if (speed == 8) section.blocks["spiral"] = fmt::format("{:.1f}", doubling_time_s(lateral.back()));
  }
  section.pictures["modes"] = modes_picture(airframe);
  section.checks = {
      at_least("all modes but the spiral die out (1: yes)", others_die_out ? 1 : 0, 1, ""),
      at_most("coupling between the longitudinal and the lateral equations", worst_coupling, 1e-6, "")};
  return section;
}

}  // namespace understory
