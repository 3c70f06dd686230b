#include <fmt/format.h>

#include "tests/validation/mismatch_sections.hpp"
#include "tests/validation/page.hpp"

namespace understory {
namespace {

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

std::string drift_findings(const std::vector<FlownCondition>& all) {
  const FlownCondition* worst = &all.front();
  for (const FlownCondition& flown : all) {
    const bool alone = flown.condition.what != adverse_name;
    if (alone && flown.tally.drift.quantile_m(drift_share) > worst->tally.drift.quantile_m(drift_share))
      worst = &flown;
  }
  const FlightTally &model = all.front().tally, &hurt = worst->tally;
  return fmt::format(
      "\nDrag, damping and delay hardly reach the estimate: the filter has no model of them. Mass and lift "
      "do, since it takes the sideslip from the winglets' force per mass. Worst alone is {}: {:.2f} m, "
      "{:.1f} "
      "times what the covariance states, where the model's own aircraft has {:.2f} m. A filter that also "
      "takes "
      "the angle of attack from the wing's force (`estimation.filter.angle_of_attack.enabled`) pays more: "
      "its "
      "`model_error` grants the force a share of error, but as noise that {} samples a second average out, "
      "and "
      "a wrong mass does not average out. It drifts {:.2f} m on the same flights, and {:.2f} m with the "
      "model's "
      "own aircraft: so it is off by default. The planner widens a point by 0.15 m after 10 m of flight, "
      "whatever this covariance says; "
      "in a forest as thin as this one the clearance that it likes to keep bears the rest. Asked: calm "
      "air's 0.15 m where the wing's force per mass is the model's; else 0.40 m, what moving air is granted "
      "across the path.\n",
      worst->condition.name(), hurt.drift.quantile_m(drift_share), hurt.drift.over_stated(),
      model.drift.quantile_m(drift_share), SensorsConfig().imu_rate_hz,
      hurt.others.front().quantile_m(drift_share), model.others.front().quantile_m(drift_share));
}

}  // namespace

Section mismatch_drift_section(const std::vector<FlownCondition>& all,
                               const std::vector<OtherFilter>& others) {
  Section section;
  section.title = "Drift of remembered obstacles";
  section.markdown =
      "By how much the error of an obstacle grows from 10 m ahead to its passing (95th percentile), by the "
      "estimate that flew; its RMS over the RMS that the filter's covariance states (1 is honest, more is "
      "overconfident); and what other filters would have made of the same flights' samples.\n\n" +
      drift_table(all, others) + drift_findings(all);
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

}  // namespace understory
