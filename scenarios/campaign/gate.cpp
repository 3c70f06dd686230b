#include "scenarios/campaign/gate.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/report/table.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace understory {
namespace {

using RowsBySeed = std::map<std::uint64_t, const FlightRow*>;

struct Metric {
  const char* name;
  double FlightRow::*value;
};
constexpr Metric metrics[]{{"mean_speed_mps", &FlightRow::mean_speed_mps},
                           {"minimum_clearance_m", &FlightRow::minimum_clearance_m},
                           {"position_error_mean_m", &FlightRow::position_error_mean_m},
                           {"progress_m", &FlightRow::progress_m}};

std::map<std::string, RowsBySeed> by_condition(const std::vector<FlightRow>& rows, const char* side) {
  std::map<std::string, RowsBySeed> conditions;
  for (const FlightRow& row : rows)
    if (!conditions[row.condition].emplace(row.seed, &row).second)
      throw ScenarioError(fmt::format("{}: '{}' seed {} is there twice", side, row.condition, row.seed));
  return conditions;
}

const FlightRow* row_of(const std::map<std::string, RowsBySeed>& conditions, const FlightRow& like) {
  const auto condition = conditions.find(like.condition);
  if (condition == conditions.end()) return nullptr;
  const auto row = condition->second.find(like.seed);
  return row == condition->second.end() ? nullptr : row->second;
}

std::vector<FlightRow> failed_to_run(const std::vector<FlightRow>& rows) {
  std::vector<FlightRow> failed;
  std::ranges::copy_if(rows, std::back_inserter(failed), [](const FlightRow& row) { return !row.flown(); });
  return failed;
}

/// Rows of `some` that `others` do not have.
std::vector<FlightRow> without_partner(const std::vector<FlightRow>& some,
                                       const std::map<std::string, RowsBySeed>& others) {
  std::vector<FlightRow> alone;
  for (const FlightRow& row : some)
    if (row_of(others, row) == nullptr) alone.push_back(row);
  return alone;
}

bool asked_alike(const FlightPair& pair) {
  const FlightRow &a = pair.baseline, &b = pair.candidate;
  return a.cruise_speed_mps == b.cruise_speed_mps && a.square_metres_per_tree == b.square_metres_per_tree &&
         a.goal_m == b.goal_m;
}

PairedOutcomes count_goals(const std::vector<FlightPair>& pairs) {
  PairedOutcomes goals;
  for (const FlightPair& pair : pairs)
    if (pair.flown()) goals.count(pair.baseline.reached_goal(), pair.candidate.reached_goal());
  return goals;
}

MetricComparison compare_metric(const std::vector<FlightPair>& pairs, const Metric& metric) {
  std::vector<double> baseline, candidate, differences;
  for (const FlightPair& pair : pairs) {
    const double before = pair.baseline.*metric.value, after = pair.candidate.*metric.value;
    if (!pair.flown() || !std::isfinite(before) || !std::isfinite(after)) continue;
    baseline.push_back(before);
    candidate.push_back(after);
    differences.push_back(after - before);
  }
  return {metric.name, static_cast<int>(differences.size()), mean_of(baseline), mean_of(candidate),
          bootstrap(differences)};
}

ConditionComparison compare_pairs(const std::string& condition, std::vector<FlightPair> pairs) {
  ConditionComparison comparison;
  comparison.condition = condition;
  comparison.goals = count_goals(pairs);
  comparison.p = mcnemar_exact_p(comparison.goals);
  comparison.difference = paired_difference_interval(comparison.goals);
  for (const Metric& metric : metrics) comparison.metrics.push_back(compare_metric(pairs, metric));
  comparison.bit_for_bit = static_cast<int>(std::ranges::count_if(pairs, [](const FlightPair& pair) {
    return pair.flown() && !pair.baseline.digest.empty() && pair.baseline.digest == pair.candidate.digest;
  }));
  comparison.pairs = std::move(pairs);
  return comparison;
}

constexpr std::size_t named_at_most = 20;  // a log is read: the JUnit file has all of them

/// "3 (goal to collision), 7, ... and 12 more"
template <typename Item, typename Word>
std::string some_of(const std::vector<Item>& items, Word&& word) {
  std::string text;
  for (std::size_t i = 0; i < std::min(items.size(), named_at_most); ++i)
    text += (i == 0 ? "" : ", ") + word(items[i]);
  if (items.size() > named_at_most) text += fmt::format(" and {} more", items.size() - named_at_most);
  return text;
}

std::string percent(double share) { return fmt::format("{:.1f}", 100 * share); }
std::string signed_percent(double share) { return fmt::format("{:+.1f}", 100 * share); }

std::string success_text(int goals, int flights) {
  const Interval interval = wilson_interval(goals, flights);
  return fmt::format("{} ({} to {})", goals, percent(interval.minimum), percent(interval.maximum));
}

void add_success(const ConditionComparison& condition, Table& table) {
  const PairedOutcomes& goals = condition.goals;
  table.add(
      condition.condition, goals.pairs(), success_text(goals.first(), goals.pairs()),
      success_text(goals.second(), goals.pairs()),
      fmt::format("{} ({} to {})", signed_percent(goals.difference()),
                  signed_percent(condition.difference.minimum), signed_percent(condition.difference.maximum)),
      goals.only_first, goals.only_second, fmt::format("{:.3g}", condition.p), condition.bit_for_bit);
}

Table success_table(const Comparison& comparison) {
  Table table{{"success, %", "pairs", "baseline goals", "candidate goals", "difference", "worse", "better",
               "p", "bit for bit"}};
  for (const ConditionComparison& condition : comparison.conditions) add_success(condition, table);
  if (comparison.conditions.size() > 1) add_success(comparison.all, table);
  return table;
}

Table metric_table(const Comparison& comparison) {
  Table table{{"means", "figure", "pairs", "baseline", "candidate", "difference"}, {}};
  for (const ConditionComparison& condition : comparison.conditions) {
    if (condition.bit_for_bit == condition.goals.pairs()) continue;  // nothing has changed
    for (const MetricComparison& metric : condition.metrics) {
      if (metric.pairs == 0) continue;
      const BootstrapEstimate& difference = metric.difference;
      std::string change = fmt::format("{:+.4f}", difference.value);
      if (std::isfinite(difference.interval.minimum))
        change +=
            fmt::format(" ({:+.4f} to {:+.4f})", difference.interval.minimum, difference.interval.maximum);
      table.add(condition.condition, metric.name, metric.pairs, number_text(metric.baseline_mean, 4),
                number_text(metric.candidate_mean, 4), change);
    }
  }
  return table;
}

std::string changed_seeds(const ConditionComparison& condition, bool worse) {
  std::vector<FlightPair> changed;
  std::ranges::copy_if(condition.pairs, std::back_inserter(changed), [worse](const FlightPair& pair) {
    return worse ? pair.got_worse() : pair.got_better();
  });
  if (changed.empty()) return "";
  return fmt::format("{}: {}: seed {}\n", worse ? "worse" : "better", condition.condition,
                     some_of(changed, [worse](const FlightPair& pair) {
                       const FlightRow& bad = worse ? pair.candidate : pair.baseline;
                       return fmt::format("{} ({} at {:.1f} m)", bad.seed, bad.outcome, bad.progress_m);
                     }));
}

std::string ids_of(const std::vector<FlightRow>& rows) {
  return some_of(rows, [](const FlightRow& row) { return row.id; });
}

std::string failures_of(const std::vector<FlightRow>& rows) {
  return some_of(rows, [](const FlightRow& row) { return fmt::format("{} ({})", row.id, row.reason); });
}

std::string flights(std::size_t count) { return count == 1 ? "1 flight" : fmt::format("{} flights", count); }

}  // namespace

Comparison compare_campaigns(const std::vector<FlightRow>& baseline,
                             const std::vector<FlightRow>& candidate) {
  const auto old_rows = by_condition(baseline, "baseline"), new_rows = by_condition(candidate, "candidate");
  std::vector<std::string> order;
  for (const FlightRow& row : baseline)
    if (std::ranges::find(order, row.condition) == order.end()) order.push_back(row.condition);

  Comparison comparison;
  std::vector<FlightPair> all;
  for (const std::string& condition : order) {
    std::vector<FlightPair> pairs;
    for (const auto& [seed, row] : old_rows.at(condition))
      if (const FlightRow* partner = row_of(new_rows, *row)) pairs.push_back({*row, *partner});
    if (pairs.empty()) continue;
    if (!std::ranges::all_of(pairs, asked_alike)) comparison.altered.push_back(condition);
    for (const auto& [old_row, new_row] : pairs)
      if (old_row.flown() && new_row.flown() && old_row.renderer != new_row.renderer)
        comparison.drawn_differently =
            fmt::format("{} in the baseline, {} in the candidate", old_row.renderer, new_row.renderer);
    all.insert(all.end(), pairs.begin(), pairs.end());
    comparison.conditions.push_back(compare_pairs(condition, std::move(pairs)));
  }
  comparison.all = compare_pairs("all", std::move(all));
  comparison.missing = without_partner(baseline, new_rows);
  comparison.added = without_partner(candidate, old_rows);
  comparison.baseline_failed = failed_to_run(baseline);
  comparison.candidate_failed = failed_to_run(candidate);
  return comparison;
}

bool dropped_too_far(const ConditionComparison& condition, const GateRule& rule) {
  const double lost = condition.goals.only_first - condition.goals.only_second;
  return lost > rule.max_drop * condition.goals.pairs() + 1e-9;  // the product is not exact, the count is
}

GateVerdict verdict_on(const Comparison& comparison, const GateRule& rule) {
  GateVerdict verdict;
  for (const ConditionComparison& condition : comparison.conditions)
    if (dropped_too_far(condition, rule))
      verdict.reasons.push_back(fmt::format(
          "{}: success fell by {} percentage points, from {} to {} of {}; at most {} are allowed (p = "
          "{:.3g})",
          condition.condition, percent(-condition.goals.difference()), condition.goals.first(),
          condition.goals.second(), condition.goals.pairs(), percent(rule.max_drop), condition.p));
  if (!comparison.candidate_failed.empty())
    verdict.reasons.push_back(fmt::format("{} of the candidate failed to run: {}",
                                          flights(comparison.candidate_failed.size()),
                                          failures_of(comparison.candidate_failed)));
  if (!comparison.missing.empty())
    verdict.reasons.push_back(fmt::format("{} of the baseline missing in the candidate: {}",
                                          flights(comparison.missing.size()), ids_of(comparison.missing)));
  if (comparison.all.goals.pairs() == 0)
    verdict.reasons.emplace_back("no flight of the two campaigns can be compared");
  return verdict;
}

std::string to_report(const Comparison& comparison, const GateVerdict& verdict, const GateRule& rule) {
  std::string text = to_text(success_table(comparison));
  text +=
      "  intervals 95 %: goals by Wilson, difference by Newcombe's paired method; p: McNemar's exact "
      "test\n\n";
  const Table metrics = metric_table(comparison);
  if (!metrics.rows.empty())
    text +=
        to_text(metrics) +
        "  difference of paired flights, 95 % interval by BCa bootstrap (too narrow below some 15 pairs)\n\n";
  for (const bool worse : {true, false})
    for (const ConditionComparison& condition : comparison.conditions)
      text += changed_seeds(condition, worse);
  for (const std::string& condition : comparison.altered)
    text +=
        fmt::format("note: {}: asked for another speed, density or goal than in the baseline\n", condition);
  if (!comparison.drawn_differently.empty())
    text += fmt::format("note: other renderers give other images, and so other flights: {}\n",
                        comparison.drawn_differently);
  if (!comparison.added.empty())
    text += fmt::format("note: {} of the candidate not in the baseline: {}\n",
                        flights(comparison.added.size()), ids_of(comparison.added));
  if (!comparison.baseline_failed.empty())
    text += fmt::format("note: {} of the baseline failed to run: {}\n",
                        flights(comparison.baseline_failed.size()), failures_of(comparison.baseline_failed));
  for (const std::string& reason : verdict.reasons) text += fmt::format("FAILED: {}\n", reason);
  if (verdict.passes())
    text +=
        fmt::format("passed: {} compared, no condition lost more than {} percentage points\n",
                    flights(static_cast<std::size_t>(comparison.all.goals.pairs())), percent(rule.max_drop));
  return text;
}

}  // namespace understory
