#include "scenarios/validation/mismatch_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/scenario_io.hpp"
#include "scenarios/validation/line_plot.hpp"
#include "scenarios/validation/mismatch_conditions.hpp"
#include "scenarios/validation/mismatch_flights.hpp"
#include "scenarios/validation/page.hpp"
#include "sim/trim.hpp"

namespace understory {
namespace {

constexpr std::uint64_t first_seed = 1000;  // development seeds: settings may have been chosen on them
constexpr int seeds = 10;                   // a condition: 130 flights of a second keep the page quick
constexpr double drift_share = 0.95;

struct Flown {
  MismatchCondition condition;
  FlightTally tally;
  AxisRange level_mps;  // where the aircraft flies level at all; empty: least above greatest
};

/// Speeds of level flight by the flat-plate model, at angles of attack that the stack's follower allows.
AxisRange level_speeds(const Scenario& scenario) {
  AxisRange range{HUGE_VAL, -HUGE_VAL};
  const double greatest_rad = scenario.autopilot.autopilot.flight_model.greatest_angle_of_attack_rad;
  for (double speed_mps = 5; speed_mps < 18; speed_mps += 0.05)
    if (straight_trim(scenario.flown_airframe(), speed_mps, 0, greatest_rad)) include(range, speed_mps);
  return range;
}

Flown fly_condition(const MismatchCondition& condition, Scenario scenario,
                    const std::filesystem::path& models_folder) {
  scenario.mismatch = condition.mismatch;
  return {condition, fly_seeds(scenario, first_seed, seeds, models_folder), level_speeds(scenario)};
}

std::string otherwise(const FlightTally& tally) {
  std::string text;
  for (const Ending ending : {Ending::collision, Ending::ground, Ending::out_of_bounds, Ending::time}) {
    if (const int count = tally.count(ending); count > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count,
                          ending == Ending::out_of_bounds ? "out of bounds" : word_for(ending));
  }
  return text.empty() ? "-" : text;
}

std::string table(const std::vector<Flown>& all) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [condition, tally, level_mps] : all) {
    const Interval success = tally.success();
    rows.push_back({condition.name(),
                    level_mps.least > level_mps.greatest
                        ? "none"
                        : fmt::format("{:.1f} to {:.1f}", level_mps.least, level_mps.greatest),
                    fmt::format("{} of {}", tally.count(Ending::goal), tally.flights()),
                    fmt::format("{:.0f} to {:.0f} %", 100 * success.least, 100 * success.greatest),
                    otherwise(tally), fmt::format("{:.1f}", tally.mean_speed_mps()),
                    fmt::format("{:.3f}", tally.drift_quantile_m(drift_share)),
                    fmt::format("{}", tally.drift_m.size()),
                    fmt::format("{:.2f}", tally.drift_over_stated())});
  }
  return markdown_table({"mismatch", "level flight (m/s)", "goals", "95 % interval", "otherwise",
                         "speed (m/s)", "drift, 95 % (m)", "obstacles", "RMS over stated"},
                        rows);
}

using Measure = double (*)(const FlightTally&);

double goals_percent(const FlightTally& tally) { return 100.0 * tally.count(Ending::goal) / tally.flights(); }
double drift_percentile(const FlightTally& tally) { return tally.drift_quantile_m(drift_share); }
double speed(const FlightTally& tally) { return tally.mean_speed_mps(); }
double honesty(const FlightTally& tally) { return tally.drift_over_stated(); }

/// A curve for every property, through the model itself at 0. The delay's percent are drawn five times
/// closer, as the adverse curve takes them.
LinePlot over_mismatch(const std::vector<Flown>& all, const std::string& title, const std::string& y_label,
                       Measure measure) {
  LinePlot plot{title, "mismatch (%; of the delay: a fifth)", y_label};
  for (const Flown& flown : all) {
    if (flown.condition.what.empty()) continue;
    if (plot.series.empty() || plot.series.back().name != flown.condition.what) {
      plot.series.push_back({flown.condition.what, {0}, {measure(all.front().tally)}, Mark::line_and_dots});
    }
    Series& series = plot.series.back();
    const double x = flown.condition.percent / (series.name == "delay" ? 5 : 1);
    const auto place = std::upper_bound(series.x.begin(), series.x.end(), x) - series.x.begin();
    series.x.insert(series.x.begin() + place, x);
    series.y.insert(series.y.begin() + place, measure(flown.tally));
  }
  return plot;
}

/// The least number of goals that the interval of the model itself allows.
int least_goals(const FlightTally& model) {
  return static_cast<int>(std::ceil(model.success().least * model.flights()));
}

std::vector<Check> checks(const std::vector<Flown>& all) {
  const FlightTally& model = all.front().tally;
  std::vector<Check> found{at_least("goals, no mismatch", model.count(Ending::goal), 9, ""),
                           at_most("drift, no mismatch", drift_percentile(model), 0.15, "m")};
  for (const Flown& flown : all) {
    if (flown.condition.what.empty()) continue;
    const std::string name = flown.condition.name();
    found.push_back(at_least("goals, " + name, flown.tally.count(Ending::goal), least_goals(model), ""));
    found.push_back(at_most("drift, " + name, drift_percentile(flown.tally), 0.15, "m"));
  }
  return found;
}

}  // namespace

ValidationPage mismatch_page(const std::filesystem::path& root) {
  Scenario scenario = load_scenario(root / "scenarios" / "library" / "forest.yaml");
  std::vector<Flown> all;
  for (const MismatchCondition& condition : mismatch_conditions())
    all.push_back(fly_condition(condition, scenario, root / "models"));

  LinePlot goals = over_mismatch(all, "Flights that reach the goal", "goals (%)", goals_percent);
  goals.y_range = AxisRange{-5, 105};
  goals.references = {{100 * all.front().tally.success().least, "least of the model's own 95 % interval"}};
  const LinePlot speeds = over_mismatch(all, "Speed", "mean speed (m/s)", speed);
  LinePlot drifts =
      over_mismatch(all, "Drift of obstacles over 10 m", "95th percentile (m)", drift_percentile);
  LinePlot honest = over_mismatch(all, "True drift over the stated", "RMS over stated RMS", honesty);

  Section section;
  section.title = "Success and drift against mismatch";
  section.markdown = table(all);
  section.figures = {{"success", "Goals and speed against mismatch", to_svg({goals, speeds}, 2)},
                     {"drift", "Drift against mismatch", to_svg({drifts, honest}, 2)}};
  section.checks = checks(all);
  ValidationPage page;
  page.file = "model_mismatch";
  page.title = "An aircraft that is not the model's";
  page.introduction = "-\n";
  page.sections = {section};
  return page;
}

}  // namespace understory
