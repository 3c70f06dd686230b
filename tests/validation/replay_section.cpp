#include <fmt/format.h>

#include <cmath>

#include "tests/validation/replay_fit.hpp"
#include "tests/validation/sections.hpp"

namespace understory {
namespace {

constexpr double half_s = 0.75;  // of the record: what may be fitted to

/// A value of the record and of both flights over time, or over another value.
LinePlot moments_panel(const char* title, const char* x_label, const char* y_label,
                       const FlightRecord& record, const FlightRecord& unfitted, const FlightRecord& fitted,
                       double (*x)(const FlightMoment&), double (*y)(const FlightMoment&)) {
  LinePlot plot{title, x_label, y_label};
  plot.series = {plotted("record", record, x, y, Mark::line, 7),
                 plotted("unfitted", unfitted, x, y, Mark::dashes, 0),
                 plotted("fitted", fitted, x, y, Mark::line, 1)};
  return plot;
}

std::string replay_picture(const FlightRecord& record, const FlightRecord& unfitted,
                           const FlightRecord& fitted) {
  const auto over_time = [&](const char* title, const char* label, double (*value)(const FlightMoment&)) {
    LinePlot plot = moments_panel(
        title, "time (s)", label, record, unfitted, fitted,
        [](const FlightMoment& moment) { return moment.t_s; }, value);
    plot.references = {{half_s, "fitted up to here", true}};
    return plot;
  };
  LinePlot path = moments_panel(
      "Path from above", "forward (m)", "left (m)", record, unfitted, fitted,
      [](const FlightMoment& moment) { return moment.position_world.x(); },
      [](const FlightMoment& moment) { return moment.position_world.y(); });
  path.equal_scale = true;
  LinePlot error{"Horizontal error", "time (s)", "horizontal error (m)"};
  error.series = {
      plotted("unfitted", errors(unfitted, record), &ReplayError::t_s, &ReplayError::horizontal_m,
              Mark::dashes, 0),
      plotted("fitted", errors(fitted, record), &ReplayError::t_s, &ReplayError::horizontal_m, Mark::line, 1),
      {"asked at most", {0.5, 1.0, 1.5}, {0.20, 0.25, 0.40}, Mark::dots, 3}};
  error.references = {{half_s, "fitted up to here", true}};
  return to_svg({path, error,
                 over_time("Roll, left wing down negative", "roll (deg)",
                           [](const FlightMoment& moment) { return moment.roll_rad() / degree; }),
                 over_time("Height by integrated velocity", "height (m)",
                           [](const FlightMoment& moment) { return moment.position_world.z(); }),
                 over_time("Pitch, nose down positive", "pitch (deg)",
                           [](const FlightMoment& moment) { return moment.pitch_rad() / degree; }),
                 over_time("Yaw, nose left positive", "yaw (deg)",
                           [](const FlightMoment& moment) { return moment.yaw_rad() / degree; })},
                2);
}

std::string error_row(const std::string& name, const std::vector<ReplayError>& error) {
  std::string row = name, rolls;
  for (const double t_s : {0.25, 0.5, 1.0, 1.5}) {
    row += fmt::format(" | {:.2f}", error_at(error, t_s).horizontal_m);
    rolls += fmt::format("{}{:+.0f}", rolls.empty() ? "" : " / ", error_at(error, t_s).roll_rad / degree);
  }
  return row + fmt::format(" | {:.2f} | {:.2f} | {} | {:.1f}", maximum_m(error, &ReplayError::horizontal_m),
                           maximum_m(error, &ReplayError::height_m), rolls, rms_roll_rad(error) / degree);
}

std::string values_of(const ReplayFit& fit) {
  std::string text;
  for (const FittedParameter& fitted : fit.parameters)
    text += fmt::format("{}{} {:.3g}{}", text.empty() ? "" : ", ", fitted.parameter->name, fitted.value,
                        std::isfinite(fitted.share) ? fmt::format(" ± {:.0f} %", 100 * fitted.share)
                                                    : " (ran to the edge of the search)");
  return text;
}

/// Every choice of parameters, fitted to the first half, and what it does to the half it has not seen.
void add_choices(Section& section, const FreeFlight& air, const Airframe& airframe,
                 const FlightRecord& record) {
  const std::vector<FreeParameter>& all = free_parameters();
  for (unsigned choice = 1; choice < 1u << all.size(); ++choice) {
    std::vector<const FreeParameter*> chosen;
    for (std::size_t i = 0; i < all.size(); ++i)
      if ((choice >> i & 1u) != 0) chosen.push_back(&all[i]);
    const ReplayFit fit = fit_replay(air, airframe, record, chosen, 0, half_s);
    const std::vector<ReplayError> error = errors(replay(air, fit.airframe, record), record);
    section.row("choices", fmt::format("{} | {:.2f} | {:.2f} | {:.2f} | {:.1f}", values_of(fit),
                                       fit.sum_of_squares / fit.unfitted_sum_of_squares,
                                       error_at(error, half_s).horizontal_m,
                                       error_at(error, 1.5).horizontal_m, rms_roll_rad(error) / degree));
  }
}

}  // namespace

Section replay_section(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record) {
  const double end_s = record.back().t_s;
  const ReplayFit fit = fit_what_can_be_told(air, airframe, record, 0, half_s),
                  second = fit_what_can_be_told(air, airframe, record, half_s, end_s),
                  whole = fit_what_can_be_told(air, airframe, record, 0, end_s);
  Airframe undelayed = airframe;
  undelayed.input_delay_s = 0;
  const FlightRecord unfitted = replay(air, airframe, record), fitted = replay(air, fit.airframe, record);
  const std::vector<ReplayError> before = errors(unfitted, record), error = errors(fitted, record);
  Section section{"replay"};
  section.row("errors", "computed [14], unfitted | 0.12 | 0.19 | 0.26 | 0.39 | | | 3 / 2 / -8 / 4 | ");
  section.row("errors", error_row("unfitted", before));
  section.row("errors", error_row("**fitted**", error));
  section.row("errors", "asked | | 0.20 | 0.25 | 0.40 | | 0.35 | 4 at 0.5 s | 4.5");
  section.row("errors", error_row("unfitted, no input delay (to compare)",
                                  errors(replay(air, undelayed, record), record)));
  add_choices(section, air, airframe, record);
  section.blocks.insert(
      {{"unfitted_roll", fmt::format("{:.1f}", rms_roll_rad(before) / degree)},
       {"fitted_middle", fmt::format("{:.2f}", error_at(error, half_s).horizontal_m)},
       {"unfitted_middle", fmt::format("{:.2f}", error_at(before, half_s).horizontal_m)},
       {"memory", fmt::format("{:.0f}", fit.residual_memory)},
       {"memory_root", fmt::format("{:.0f}", std::sqrt(fit.residual_memory))},
       {"first", values_of(fit)},
       {"correlation",
        fmt::format("{:.2f}", fit.parameters.size() == 2 ? fit.correlation(0, 1) : std::nan(""))},
       {"second", values_of(second)},
       {"whole", values_of(whole)},
       {"contradiction", fmt::format("{:.2f}", maximum_contradiction_m(record))}});
  section.pictures["replay"] = replay_picture(record, unfitted, fitted);
  section.checks = {
      at_most("replayed jog, horizontal at 0.5 s", error_at(error, 0.5).horizontal_m, 0.20, "m"),
      at_most("replayed jog, horizontal at 1.0 s", error_at(error, 1.0).horizontal_m, 0.25, "m"),
      at_most("replayed jog, horizontal at 1.5 s", error_at(error, 1.5).horizontal_m, 0.40, "m"),
      at_most("replayed jog, height at any time", maximum_m(error, &ReplayError::height_m), 0.35, "m"),
      at_most("replayed jog, roll at 0.5 s", std::abs(error_at(error, 0.5).roll_rad) / degree, 4, "deg"),
      at_most("replayed jog, roll RMS", rms_roll_rad(error) / degree, 4.5, "deg"),
      at_most("replayed jog, parameters fitted", static_cast<double>(fit.parameters.size()), 3, "")};
  return section;
}

}  // namespace understory
