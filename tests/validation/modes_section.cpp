#include "tests/validation/modes_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/report/line_plot.hpp"
#include "tests/validation/modes.hpp"
#include "tests/validation/page.hpp"

namespace understory {
namespace {

constexpr double slowest_mps = 8.0, fastest_mps = 12.7;  // of level flight

std::optional<SteadyFlight> level_trim(const Airframe& airframe, double speed_mps) {
  SteadyFlight given;
  given.airspeed_mps = speed_mps;
  return steady_flight(airframe, given, Solved::thrust);
}

/// The value of every mode called `name` over speed, ordered for one line.
Series mode_series(const Airframe& airframe, const std::string& name, double (*value)(const Mode&),
                   int colour) {
  Series series{name};
  series.colour = colour;
  for (double speed = slowest_mps; speed < fastest_mps + 1e-9; speed += 0.1) {
    const std::optional<SteadyFlight> trim = level_trim(airframe, speed);
    if (!trim) continue;
    const Modes found = modes(airframe, *trim);
    for (const std::vector<Mode>* set : {&found.longitudinal, &found.lateral}) {
      for (const Mode& mode : *set) {
        if (mode.name != name) continue;
        series.x.push_back(speed);
        series.y.push_back(value(mode));
      }
    }
  }
  return series;
}

/// The same in every panel.
int colour_of(const std::string& name) {
  const std::vector<std::string> names{"short period", "short period, fast part", "short period, slow part",
                                       "phugoid",      "roll subsidence",         "dutch roll",
                                       "spiral"};
  const auto place = std::find(names.begin(), names.end(), name) - names.begin();
  return static_cast<int>(place < 4 ? place : place - 4);
}

Figure modes_figure(const Airframe& airframe) {
  const auto real = [](const Mode& mode) { return mode.eigenvalue.real(); };
  const auto imaginary = [](const Mode& mode) { return mode.eigenvalue.imag(); };
  const auto plot = [&](const char* title, const char* label, const std::vector<std::string>& names,
                        double (*value)(const Mode&)) {
    LinePlot panel{title, "airspeed (m/s)", label};
    for (const std::string& name : names)
      panel.series.push_back(mode_series(airframe, name, value, colour_of(name)));
    panel.references = {{0}};
    return panel;
  };
  const std::vector<std::string> along{"short period", "short period, fast part", "short period, slow part",
                                       "phugoid"};
  const std::vector<std::string> across{"roll subsidence", "dutch roll", "spiral"};
  return {"modes",
          "Eigenvalues of the linearised flight over speed: real part (below 0: dies out) and, where it "
          "swings, imaginary part",
          to_svg({plot("Longitudinal: how fast it dies out", "real part (1/s)", along, real),
                  plot("Lateral: how fast it dies out", "real part (1/s)", across, real),
                  plot("Longitudinal: how fast it swings", "imaginary part (rad/s)",
                       {"short period", "phugoid"}, imaginary),
                  plot("Lateral: how fast it swings", "imaginary part (rad/s)", {"dutch roll"}, imaginary)},
                 2)};
}

std::string mode_text(const Mode& mode) {
  if (mode.swings())
    return fmt::format("{:.2f} rad/s, damping {:.2f}", mode.frequency_radps(), mode.damping());
  if (mode.eigenvalue.real() > 0)
    return fmt::format("grows, doubles in {:.1f} s", std::log(2.0) / mode.eigenvalue.real());
  return fmt::format("dies out, time constant {:.2f} s", mode.time_constant_s());
}

/// A name's modes together: an overdamped short period has two.
std::string text_of(const std::vector<Mode>& set, const std::string& name) {
  std::string text;
  for (const Mode& mode : set)
    if (mode.name.starts_with(name)) text += (text.empty() ? "" : "; ") + mode_text(mode);
  return text;
}

}  // namespace

Section modes_section(const Airframe& airframe) {
  std::vector<std::vector<std::string>> rows;
  double worst_coupling = 0;
  bool others_die_out = true;
  for (const double speed : {8.0, 9.0, 10.0, 11.0, 12.27, 12.7}) {
    const std::optional<SteadyFlight> trim = level_trim(airframe, speed);
    if (!trim) continue;
    const Modes found = modes(airframe, *trim);
    worst_coupling = std::max(worst_coupling, found.coupling);
    for (const std::vector<Mode>* set : {&found.longitudinal, &found.lateral}) {
      for (const Mode& mode : *set) {
        if (mode.name != "spiral") others_die_out = others_die_out && mode.eigenvalue.real() < 0;
      }
    }
    rows.push_back({fmt::format("{:g}", speed), text_of(found.longitudinal, "short period"),
                    text_of(found.longitudinal, "phugoid"), text_of(found.lateral, "roll subsidence"),
                    text_of(found.lateral, "dutch roll"), text_of(found.lateral, "spiral")});
  }
  Section section;
  section.title = "Modes";
  section.markdown =
      "The six equations of the rigid body under `aerodynamic_wrench` and gravity, linearised by central "
      "differences about level trim, controls held. tests/scenarios/flight_analysis_test.cpp holds these "
      "equations against a step of MuJoCo and the eigenvalues against closed forms.\n\n" +
      markdown_table({"airspeed (m/s)", "short period", "phugoid", "roll subsidence", "dutch roll", "spiral"},
                     rows) +
      "\n"
      "The flat plates make no pitching moment of their own: the elevons' lift behind the centre of mass "
      "is all the stability there is, and the identified pitch damping (0.115 N m s/rad) makes the short "
      "period so stiff that below 10 m/s it no longer swings. Drag of about 0.8 of the lift damps the "
      "phugoid heavily. The dutch roll is weakly damped (the identified yaw damping is zero; only the "
      "winglets damp) and the spiral opens: at 12 m/s slowly, at 8 m/s it doubles in 2.3 s, faster than "
      "the 4 s that MIL-F-8785C leaves a pilot at worst. The path follower, whose bank loop has 9 rad/s, "
      "does not notice. FACTS gives no modes to hold these against.\n";
  section.figures = {modes_figure(airframe)};
  section.checks = {
      at_least("all modes but the spiral die out (1: yes)", others_die_out ? 1 : 0, 1, ""),
      at_most("coupling between the longitudinal and the lateral equations", worst_coupling, 1e-6, "")};
  return section;
}

}  // namespace understory
