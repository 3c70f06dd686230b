#include "scenarios/campaign/gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scenarios/config/config_tree.hpp"

namespace understory {
namespace {

using RowsBySeed = std::map<std::uint64_t, const FlightRow*>;

struct Metric {
  const char* name;
  double FlightRow::*value;
};
constexpr Metric metrics[]{{"mean_speed_mps", &FlightRow::mean_speed_mps},
                           {"min_clearance_m", &FlightRow::min_clearance_m},
                           {"position_error_mean_m", &FlightRow::position_error_mean_m},
                           {"progress_m", &FlightRow::progress_m}};

std::map<std::string, RowsBySeed> by_condition(const std::vector<FlightRow>& rows, const char* side) {
  std::map<std::string, RowsBySeed> conditions;
  for (const FlightRow& row : rows)
    if (!conditions[row.condition].emplace(row.seed, &row).second)
      throw ScenarioError(fmt::format("{}: expected each flight once, '{}' seed {} is there twice", side,
                                      row.condition, row.seed));
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

}  // namespace understory
