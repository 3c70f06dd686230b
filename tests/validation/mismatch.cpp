#include "tests/validation/mismatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/scenario/scenario_io.hpp"
#include "sim/aircraft/aerodynamics.hpp"
#include "tests/validation/sections.hpp"

namespace understory {
namespace {

constexpr const char* forest = UNDERSTORY_SOURCE_DIR "/scenarios/library/forest.yaml";
constexpr const char* all_adverse = "all adverse";  // the curve on which everything is adverse at once
constexpr Seeds seeds{1000, 10};                    // of development: settings may have been chosen on them

/// How `filter` drifts along the flight's own samples: the same sensors, faults and seed as fly() had.
std::vector<Drift> drifts_with(const FilterConfig& filter, const FlightTrace& flight) {
  constexpr double sight_m = 10;  // the long rig's detection depth, and the distance the drift goals speak of
  TrialConfig config = trial_of(flight, flight.scenario.sensor_seed());
  config.filter = filter;
  return drifts(flight, run_trial(flight, config), sight_m);
}

/// One that the flights' samples are given to beside the filter that flew.
struct OtherFilter {
  const char* name;
  FilterConfig filter;
};

std::vector<OtherFilter> other_filters(const FilterConfig& flown) {
  std::vector<OtherFilter> others{{"and angle of attack", flown}, {"no sideslip", flown}};
  others.front().filter.angle_of_attack.enabled = true;
  others.back().filter.sideslip.model = SideslipModel::off;
  others.push_back({"preset windy", load_scenario(forest, {"estimation.preset=windy"}).estimation.filter()});
  return others;
}

struct FlownCondition {
  MismatchCondition condition;
  FlightTally tally;
  AxisRange level_mps;  ///< where the aircraft flies level at all; nowhere: the minimum above the maximum

  bool flies_level() const { return level_mps.minimum <= level_mps.maximum; }
};

/// Speeds of level flight by the flat-plate model, at angles of attack that the stack's follower allows.
AxisRange level_speeds(const Scenario& scenario) {
  AxisRange range{HUGE_VAL, -HUGE_VAL};
  const double cap_rad = scenario.autopilot.flight_model.maximum_angle_of_attack_rad;
  for (double speed_mps = 5; speed_mps < 18; speed_mps += 0.05)
    if (straight_trim(scenario.flown_airframe(), speed_mps, 0, cap_rad)) include(range, speed_mps);
  return range;
}

std::vector<FlownCondition> fly_all(Scenario scenario, const std::vector<OtherFilter>& others) {
  std::vector<FilterConfig> filters;
  for (const OtherFilter& other : others) filters.push_back(other.filter);
  std::vector<FlownCondition> all;
  for (const MismatchCondition& condition : mismatch_conditions()) {
    scenario.mismatch = condition.mismatch;
    all.push_back({condition, fly_seeds(scenario, filters, seeds), level_speeds(scenario)});
  }
  return all;
}

using Measure = std::function<double(const FlightTally&)>;

double drift_m(const FlightTally& tally) { return tally.drift.quantile_m(); }

/// One condition's curve over its percent, through the model itself (the first of `all`) at 0. The delay's
/// percent are drawn five times closer, as the adverse aircraft has them.
Series curve(const std::vector<FlownCondition>& all, const std::string& what, const std::string& name,
             const Measure& measure) {
  std::vector<std::pair<double, double>> points{{0, measure(all.front().tally)}};
  for (const FlownCondition& flown : all)
    if (flown.condition.what == what)
      points.emplace_back(flown.condition.percent / (what == "delay" ? 5 : 1), measure(flown.tally));
  std::sort(points.begin(), points.end());
  return plotted(name, points, &std::pair<double, double>::first, &std::pair<double, double>::second,
                 Mark::line_and_dots);
}

/// The curves of every property.
LinePlot curves(const std::vector<FlownCondition>& all, const std::string& title, const std::string& y_label,
                const Measure& measure) {
  LinePlot plot{title, "mismatch (%; of the delay: a fifth)", y_label};
  for (const char* what : {"mass", "lift", "drag", "damping", "delay", all_adverse})
    plot.series.push_back(curve(all, what, what, measure));
  return plot;
}

LinePlot by_filter(const std::vector<FlownCondition>& all, const std::string& what,
                   const std::vector<OtherFilter>& others) {
  LinePlot plot{"The same flights, other filters: " + what, fmt::format("mismatch of {} (%)", what),
                "drift, 95th percentile (m)"};
  plot.series = {curve(all, what, "as flown", drift_m)};
  for (std::size_t i = 0; i < others.size(); ++i)
    plot.series.push_back(curve(all, what, others[i].name,
                                [i](const FlightTally& tally) { return tally.others[i].quantile_m(); }));
  return plot;
}

std::string text_of_failures(const FlightTally& tally) {
  std::string text;
  for (const Outcome outcome : {Outcome::collision, Outcome::ground, Outcome::out_of_bounds, Outcome::time})
    if (const int count = tally.count(outcome); count > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count,
                          outcome == Outcome::out_of_bounds ? "out of bounds" : word_for(outcome));
  return text;
}

Section success_section(const std::vector<FlownCondition>& all) {
  Section section{"success"};
  for (const FlownCondition& flown : all) {
    const FlightTally& tally = flown.tally;
    const AxisRange& level = flown.level_mps;
    const Interval success = tally.success();
    section.row(
        "table",
        fmt::format(
            "{} | {} | {:.1f} | {} of {} | {:.0f} to {:.0f} % | {}", flown.condition.name(),
            flown.flies_level() ? fmt::format("{:.1f} to {:.1f}", level.minimum, level.maximum) : "nowhere",
            tally.mean_speed_mps(), tally.goals(), tally.flights(), 100 * success.minimum,
            100 * success.maximum, text_of_failures(tally)));
  }
  const FlightTally& model = all.front().tally;
  LinePlot goals = curves(all, "Flights that reach the goal", "goals (%)",
                          [](const FlightTally& tally) { return 100.0 * tally.goals() / tally.flights(); });
  goals.y_range = AxisRange{-5, 105};
  goals.references = {{100 * model.success().minimum, "least of the model's own 95 % interval"}};
  const LinePlot speeds = curves(all, "Speed", "mean speed (m/s)", &FlightTally::mean_speed_mps);
  section.pictures["success"] = to_svg({goals, speeds}, 2);
  section.checks = {at_least("goals, no mismatch", model.goals(), 9, "")};
  const double minimum_goals = std::ceil(model.success().minimum * model.flights());
  for (const FlownCondition& flown : all)
    if (!flown.condition.what.empty() && flown.flies_level())
      section.checks.push_back(
          at_least("goals, " + flown.condition.name(), flown.tally.goals(), minimum_goals, ""));
  return section;
}

/// Of the aircraft that differ in one property the one whose map drifts farthest.
const FlownCondition& worst_alone(const std::vector<FlownCondition>& all) {
  const FlownCondition* worst = &all.front();
  for (const FlownCondition& flown : all)
    if (flown.condition.what != all_adverse && drift_m(flown.tally) > drift_m(worst->tally)) worst = &flown;
  return *worst;
}

Section map_drift_section(const std::vector<FlownCondition>& all, const std::vector<OtherFilter>& others) {
  Section section{"drift"};
  for (const FlownCondition& flown : all) {
    const DriftTally& drift = flown.tally.drift;
    std::string row = fmt::format("{} | {} | {:.2f} | {:.1f}", flown.condition.name(), drift.total_m.size(),
                                  drift.quantile_m(), drift.over_stated());
    for (const DriftTally& other : flown.tally.others) row += fmt::format(" | {:.2f}", other.quantile_m());
    section.row("table", row);
    if (!flown.flies_level()) continue;
    const MismatchConfig& mismatch = flown.condition.mismatch;
    const bool wing_force_is_the_models = mismatch.mass_percent == 0 && mismatch.lift_percent == 0;
    section.checks.push_back(
        at_most("drift, " + (flown.condition.what.empty() ? "no mismatch" : flown.condition.name()),
                drift.quantile_m(), wing_force_is_the_models ? 0.15 : 0.40, "m"));
  }
  const FlownCondition& worst = worst_alone(all);
  const FlightTally &model = all.front().tally, &hurt = worst.tally;
  section.blocks.insert({{"worst", worst.condition.name()},
                         {"worst_drift", fmt::format("{:.2f}", drift_m(hurt))},
                         {"worst_over_stated", fmt::format("{:.1f}", hurt.drift.over_stated())},
                         {"model", fmt::format("{:.2f}", drift_m(model))},
                         {"worst_attack", fmt::format("{:.2f}", hurt.others.front().quantile_m())},
                         {"model_attack", fmt::format("{:.2f}", model.others.front().quantile_m())}});
  LinePlot drift = curves(all, "Drift over 10 m", "95th percentile (m)", drift_m);
  LinePlot honesty = curves(all, "True drift over the stated", "RMS over stated RMS",
                            [](const FlightTally& tally) { return tally.drift.over_stated(); });
  drift.references = {{0.15, "calm air's goal: 0.15 m"}};
  honesty.references = {{1, "honest"}};
  section.pictures["drift"] =
      to_svg({drift, honesty, by_filter(all, "mass", others), by_filter(all, "lift", others)}, 2);
  return section;
}

}  // namespace

std::string MismatchCondition::name() const {
  return what.empty() ? "none" : fmt::format("{} {:+g} %", what, percent);
}

MismatchConfig adverse(double percent) {
  MismatchConfig mismatch;
  mismatch.mass_percent = percent;
  mismatch.lift_percent = -percent;
  mismatch.drag_percent = percent;
  mismatch.damping_percent = -percent;
  mismatch.delay_percent = 5 * percent;  // a delay is known least well: another 10 ms is soon overlooked
  return mismatch;
}

std::vector<MismatchCondition> mismatch_conditions() {
  std::vector<MismatchCondition> conditions(1);
  const auto add = [&](const char* what, double MismatchConfig::*property,
                       std::initializer_list<double> all) {
    for (const double percent : all) {
      conditions.push_back({what, percent});
      conditions.back().mismatch.*property = percent;
    }
  };
  // A fifth is more than a scale or a wind tunnel leaves. Not flown, for time: more damping and a shorter
  // delay, which only add stability; a lift 10 % less, to the wing what a mass 10 % more is.
  add("mass", &MismatchConfig::mass_percent, {-20, 10, 20});
  add("lift", &MismatchConfig::lift_percent, {-20, 20});
  add("drag", &MismatchConfig::drag_percent, {-20, 20});
  add("damping", &MismatchConfig::damping_percent, {-20});
  add("delay", &MismatchConfig::delay_percent, {100});
  for (const double percent : {10.0, 15.0}) conditions.push_back({all_adverse, percent, adverse(percent)});
  return conditions;
}

int FlightTally::count(Outcome outcome) const {
  return static_cast<int>(std::count(outcomes.begin(), outcomes.end(), outcome));
}

FlightTally fly_seeds(Scenario scenario, const std::vector<FilterConfig>& others, const Seeds& seeds) {
  FlightTally tally;
  tally.others.resize(others.size());
  for (int i = 0; i < seeds.count; ++i) {
    scenario.seed = seeds.first + static_cast<std::uint64_t>(i);
    const FlightTrace flight = traced_flight(scenario, "filter");
    tally.outcomes.push_back(flight.result.outcome);
    tally.speed_sum_mps += flight.result.mean_speed_mps;
    tally.drift.add(drifts_with(scenario.estimation.filter(), flight));
    for (std::size_t other = 0; other < others.size(); ++other)
      tally.others[other].add(drifts_with(others[other], flight));
  }
  return tally;
}

std::vector<Section> mismatch_sections() {
  const Scenario scenario = load_scenario(forest);
  const std::vector<OtherFilter> others = other_filters(scenario.estimation.filter());
  const std::vector<FlownCondition> all = fly_all(scenario, others);
  return {success_section(all), map_drift_section(all, others)};
}

}  // namespace understory
