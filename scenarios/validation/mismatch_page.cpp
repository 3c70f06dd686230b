#include "scenarios/validation/mismatch_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "scenarios/scenario_io.hpp"
#include "scenarios/validation/line_plot.hpp"
#include "scenarios/validation/mismatch_conditions.hpp"
#include "scenarios/validation/mismatch_flights.hpp"
#include "scenarios/validation/page.hpp"
#include "sim/trim.hpp"

namespace understory {
namespace {

constexpr Seeds seeds{1000, 10};  // of development: settings may have been chosen on them
constexpr double drift_share = 0.95;

struct FlownCondition {
  MismatchCondition condition;
  FlightTally tally;
  AxisRange level_mps;  ///< where the aircraft flies level at all; nowhere: the least above the greatest
};

struct OtherFilter {
  const char* name;
  FilterConfig filter;
};

std::vector<OtherFilter> other_filters(const std::filesystem::path& forest, const FilterConfig& flown) {
  std::vector<OtherFilter> others{{"without angle of attack", flown}, {"nor sideslip", flown}};
  for (OtherFilter& other : others) other.filter.angle_of_attack.enabled = false;
  others.back().filter.sideslip.model = SideslipModel::off;
  others.push_back({"preset windy", load_scenario(forest, {"estimation.preset=windy"}).estimation.filter});
  return others;
}

/// Speeds of level flight by the flat-plate model, at angles of attack that the stack's follower allows.
AxisRange level_speeds(const Scenario& scenario) {
  AxisRange range{HUGE_VAL, -HUGE_VAL};
  const double greatest_rad = scenario.autopilot.autopilot.flight_model.greatest_angle_of_attack_rad;
  for (double speed_mps = 5; speed_mps < 18; speed_mps += 0.05)
    if (straight_trim(scenario.flown_airframe(), speed_mps, 0, greatest_rad)) include(range, speed_mps);
  return range;
}

std::vector<FlownCondition> fly_all(Scenario scenario, const std::vector<OtherFilter>& others,
                                    const std::filesystem::path& models_folder) {
  std::vector<FilterConfig> filters;
  for (const OtherFilter& other : others) filters.push_back(other.filter);
  std::vector<FlownCondition> all;
  for (const MismatchCondition& condition : mismatch_conditions()) {
    scenario.mismatch = condition.mismatch;
    all.push_back({condition, fly_seeds(scenario, filters, seeds, models_folder), level_speeds(scenario)});
  }
  return all;
}

std::string endings_text(const FlightTally& tally) {
  std::string text;
  for (const Ending ending : {Ending::collision, Ending::ground, Ending::out_of_bounds, Ending::time}) {
    if (const int count = tally.count(ending); count > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count,
                          ending == Ending::out_of_bounds ? "out of bounds" : word_for(ending));
  }
  return text;
}

bool flies_level(const FlownCondition& flown) { return flown.level_mps.least <= flown.level_mps.greatest; }

std::string success_table(const std::vector<FlownCondition>& all) {
  std::vector<std::vector<std::string>> rows;
  for (const FlownCondition& flown : all) {
    const FlightTally& tally = flown.tally;
    const Interval success = tally.success();
    rows.push_back({flown.condition.name(),
                    flies_level(flown)
                        ? fmt::format("{:.1f} to {:.1f}", flown.level_mps.least, flown.level_mps.greatest)
                        : "nowhere",
                    fmt::format("{:.1f}", tally.mean_speed_mps()),
                    fmt::format("{} of {}", tally.goals(), tally.flights()),
                    fmt::format("{:.0f} to {:.0f} %", 100 * success.least, 100 * success.greatest),
                    endings_text(tally)});
  }
  return markdown_table(
      {"mismatch", "flies level at (m/s)", "flew at (m/s)", "goals", "95 % interval", "else"}, rows);
}

std::string drift_table(const std::vector<FlownCondition>& all, const std::vector<OtherFilter>& others) {
  std::vector<std::string> header{"mismatch", "obstacles", "as flown (m)", "RMS over the stated"};
  for (const OtherFilter& other : others) header.push_back(fmt::format("{} (m)", other.name));
  std::vector<std::vector<std::string>> rows;
  for (const FlownCondition& flown : all) {
    const DriftTally& drift = flown.tally.drift;
    std::vector<std::string>& row = rows.emplace_back();
    row = {flown.condition.name(), fmt::format("{}", drift.total_m.size()),
           fmt::format("{:.2f}", drift.quantile_m(drift_share)), fmt::format("{:.1f}", drift.over_stated())};
    for (const DriftTally& other : flown.tally.others)
      row.push_back(fmt::format("{:.2f}", other.quantile_m(drift_share)));
  }
  return markdown_table(header, rows);
}

using Measure = std::function<double(const FlightTally&)>;

/// One property's curve through the model itself at 0. The delay's percent are drawn five times closer, as
/// the adverse aircraft has them.
Series curve(const std::vector<FlownCondition>& all, const std::string& what, const Measure& measure) {
  std::vector<std::pair<double, double>> points{{0, measure(all.front().tally)}};
  for (const FlownCondition& flown : all)
    if (flown.condition.what == what)
      points.emplace_back(flown.condition.percent / (what == "delay" ? 5 : 1), measure(flown.tally));
  std::sort(points.begin(), points.end());
  Series series{what};
  series.mark = Mark::line_and_dots;
  for (const auto& [x, y] : points) {
    series.x.push_back(x);
    series.y.push_back(y);
  }
  return series;
}

LinePlot curves(const std::vector<FlownCondition>& all, const std::string& title, const std::string& y_label,
                const Measure& measure) {
  LinePlot plot{title, "mismatch (%; of the delay: a fifth)", y_label};
  for (const char* what : {"mass", "lift", "drag", "damping", "delay", adverse_name})
    plot.series.push_back(curve(all, what, measure));
  return plot;
}

LinePlot by_filter(const std::vector<FlownCondition>& all, const std::string& what,
                   const std::vector<OtherFilter>& others) {
  LinePlot plot{fmt::format("The same flights, other filters: {}", what),
                fmt::format("mismatch of {} (%)", what), "drift, 95th percentile (m)"};
  plot.series = {
      curve(all, what, [](const FlightTally& tally) { return tally.drift.quantile_m(drift_share); })};
  plot.series.front().name = "as flown";
  for (std::size_t i = 0; i < others.size(); ++i) {
    plot.series.push_back(
        curve(all, what, [i](const FlightTally& tally) { return tally.others[i].quantile_m(drift_share); }));
    plot.series.back().name = others[i].name;
  }
  return plot;
}

/// Whether the filter's own model of the wing, and so its drift, is touched.
bool touches_wing_force(const MismatchConfig& mismatch) {
  return mismatch.mass_percent != 0 || mismatch.lift_percent != 0;
}

Section success_section(const std::vector<FlownCondition>& all) {
  const FlightTally& model = all.front().tally;
  const double least_goals = std::ceil(model.success().least * model.flights());
  Section section;
  section.title = "Success";
  section.markdown = success_table(all);
  LinePlot goals = curves(all, "Flights that reach the goal", "goals (%)",
                          [](const FlightTally& tally) { return 100.0 * tally.goals() / tally.flights(); });
  goals.y_range = AxisRange{-5, 105};
  goals.references = {{100 * model.success().least, "least of the model's own 95 % interval"}};
  const LinePlot speeds = curves(all, "Speed", "mean speed (m/s)",
                                 [](const FlightTally& tally) { return tally.mean_speed_mps(); });
  section.figures = {{"success", "Success and speed over mismatch", to_svg({goals, speeds}, 2)}};
  section.checks = {at_least("goals, no mismatch", model.goals(), 9, "")};
  for (const FlownCondition& flown : all)
    if (!flown.condition.what.empty() && flies_level(flown))
      section.checks.push_back(
          at_least("goals, " + flown.condition.name(), flown.tally.goals(), least_goals, ""));
  return section;
}

Section drift_section(const std::vector<FlownCondition>& all, const std::vector<OtherFilter>& others) {
  Section section;
  section.title = "Drift of remembered obstacles";
  section.markdown = drift_table(all, others);
  LinePlot drift = curves(all, "Drift over 10 m", "95th percentile (m)",
                          [](const FlightTally& tally) { return tally.drift.quantile_m(drift_share); });
  LinePlot honesty = curves(all, "True drift over the stated", "RMS over stated RMS",
                            [](const FlightTally& tally) { return tally.drift.over_stated(); });
  drift.references = {{0.15, "calm air's goal: 0.15 m"}};
  honesty.references = {{1, "honest"}};
  section.figures = {
      {"drift", "Drift of remembered obstacles over mismatch",
       to_svg({drift, honesty, by_filter(all, "mass", others), by_filter(all, "lift", others)}, 2)}};
  for (const FlownCondition& flown : all) {
    if (!flies_level(flown)) continue;
    const double limit_m = touches_wing_force(flown.condition.mismatch) ? 0.40 : 0.15;
    const std::string name = flown.condition.what.empty() ? "no mismatch" : flown.condition.name();
    section.checks.push_back(
        at_most("drift, " + name, flown.tally.drift.quantile_m(drift_share), limit_m, "m"));
  }
  return section;
}

}  // namespace

ValidationPage mismatch_page(const std::filesystem::path& root) {
  const std::filesystem::path forest = root / "scenarios" / "library" / "forest.yaml";
  const Scenario scenario = load_scenario(forest);
  const std::vector<OtherFilter> others = other_filters(forest, scenario.estimation.filter);
  const std::vector<FlownCondition> all = fly_all(scenario, others, root / "models");
  ValidationPage page;
  page.file = "model_mismatch";
  page.title = "An aircraft that is not the model's";
  page.introduction = "-\n";
  page.sections = {success_section(all), drift_section(all, others)};
  return page;
}

}  // namespace understory
