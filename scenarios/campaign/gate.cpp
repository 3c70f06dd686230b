#include "scenarios/campaign/gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "perception/io/field_reader.hpp"
#include "scenarios/config/config_tree.hpp"

namespace understory {
namespace {

using RowsBySeed = std::map<std::uint64_t, const FlightRow*>;

struct Metric {
  std::string_view name;
  double FlightRow::*value;
  bool less_is_better = false;
};
constexpr Metric metrics[]{{"mean_speed_mps", &FlightRow::mean_speed_mps},
                           {"minimum_clearance_m", &FlightRow::minimum_clearance_m},
                           {"position_error_mean_m", &FlightRow::position_error_mean_m, true},
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

/// What the candidate was asked otherwise: "goal at 75 m instead of 1015 m"; empty: nothing.
std::string asked_otherwise(const FlightPair& pair) {
  const FlightRow &a = pair.baseline, &b = pair.candidate;
  if (a.goal_m != b.goal_m) return fmt::format("goal at {} m instead of {} m", b.goal_m, a.goal_m);
  if (a.cruise_speed_mps != b.cruise_speed_mps)
    return fmt::format("cruise speed {} m/s instead of {} m/s", b.cruise_speed_mps, a.cruise_speed_mps);
  if (a.square_metres_per_tree != b.square_metres_per_tree)
    return fmt::format("{} m^2 per tree instead of {}", b.square_metres_per_tree, a.square_metres_per_tree);
  return "";
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
  return {std::string(metric.name), static_cast<int>(differences.size()), mean_of(baseline),
          mean_of(candidate), bootstrap(differences)};
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

GateCounts counts_of(const Comparison& comparison) {
  GateCounts counts{comparison.all.signs(), {}};
  for (const ConditionComparison& condition : comparison.conditions)
    counts.conditions.push_back(condition.signs());
  return counts;
}

/// Where it fell: over all pairs, unless one condition says more.
std::string reason_of_fall(const Comparison& comparison) {
  const ConditionComparison* most = &comparison.all;
  const auto evidence = [](const ConditionComparison& one) {
    return log_evidence_above(one.signs().mirrored(), 0);
  };
  for (const ConditionComparison& condition : comparison.conditions)
    if (evidence(condition) >= evidence(*most)) most = &condition;
  const PairedOutcomes& goals = most->goals;
  return fmt::format("{}: success fell by {:.1f} percentage points, from {} to {} of {}", most->condition,
                     -100 * goals.difference(), goals.first(), goals.second(), goals.pairs());
}

/// The smallest net loss, as a share of the pairs, that is called worse if as many gain as did and the losses
/// are spread over the conditions; 2 if none is.
double smallest_shown(GateCounts counts, const GateRule& rule) {
  const double all = counts.all.total();
  counts.all.even += counts.all.down, counts.all.down = 0;
  for (SignCounts& condition : counts.conditions) condition.even += condition.down, condition.down = 0;
  for (std::size_t lost = 0; counts.all.even > 0; ++lost) {
    SignCounts& condition = counts.conditions[lost % counts.conditions.size()];
    if (condition.even <= 0) return 2;
    for (SignCounts* signs : {&counts.all, &condition}) --signs->even, ++signs->down;
    if (verdict_on(counts, rule) == Verdict::worse) return (counts.all.down - counts.all.up) / all;
  }
  return 2;
}

/// The pairs that are missing to a verdict if more come out as these did; 0: beyond a hundred times as many.
int pairs_missing(const GateCounts& counts, const GateRule& rule) {
  const auto scaled = [](const SignCounts& signs, double times) {
    return SignCounts{signs.up * times, signs.even * times, signs.down * times};
  };
  for (double times = 1.02; times < 100; times *= 1.02) {
    GateCounts more{scaled(counts.all, times), {}};
    for (const SignCounts& condition : counts.conditions) more.conditions.push_back(scaled(condition, times));
    if (verdict_on(more, rule) != Verdict::undecided)
      return static_cast<int>(std::ceil((times - 1) * counts.all.total()));
  }
  return 0;
}

/// A loss beyond the tolerance that is shown is worse; one that is not ruled out leaves a verdict that passes
/// undecided. By the 95 % interval that the report prints.
void judge(const Tolerance& tolerance, const ConditionComparison& all, GateVerdict& verdict) {
  const MetricComparison& metric = *std::ranges::find(all.metrics, tolerance.figure, &MetricComparison::name);
  Interval gain = metric.difference.interval;
  if (std::ranges::find(metrics, tolerance.figure, &Metric::name)->less_is_better)
    gain = {-gain.maximum, -gain.minimum};
  const bool can_tell = metric.pairs >= 15;
  if (can_tell && gain.minimum > -tolerance.loss) return;
  const bool is_worse = can_tell && gain.maximum < -tolerance.loss;
  if (is_worse || verdict.passes()) verdict.verdict = is_worse ? Verdict::worse : Verdict::undecided;
  verdict.reasons.push_back(
      can_tell ? fmt::format("{} is worse by {:.3g} to {:.3g} at this one look, and {:.3g} is tolerated",
                             tolerance.figure, std::max(0.0, -gain.maximum), -gain.minimum, tolerance.loss)
               : fmt::format("{} is known of {} pairs, and 15 are needed", tolerance.figure, metric.pairs));
}

}  // namespace

Comparison compare_campaigns(const std::vector<FlightRow>& baseline, const std::vector<FlightRow>& candidate,
                             const std::optional<std::string>& drawn_differently) {
  const auto old_rows = by_condition(baseline, "baseline"), new_rows = by_condition(candidate, "candidate");
  std::vector<std::string> order;
  for (const FlightRow& row : baseline)
    if (std::ranges::find(order, row.condition) == order.end()) order.push_back(row.condition);

  Comparison comparison;
  comparison.drawn_differently = drawn_differently.value_or("");
  std::vector<FlightPair> all;
  for (const std::string& condition : order) {
    std::vector<FlightPair> pairs;
    for (const auto& [seed, row] : old_rows.at(condition))
      if (const FlightRow* partner = row_of(new_rows, *row)) pairs.push_back({*row, *partner});
    if (pairs.empty()) continue;
    for (const FlightPair& pair : pairs)
      if (const std::string other = asked_otherwise(pair); !other.empty()) {
        comparison.altered.push_back(condition + ": " + other);
        break;
      }
    for (const auto& [old_row, new_row] : pairs)
      if (!drawn_differently && old_row.flown() && new_row.flown() && old_row.renderer != new_row.renderer)
        comparison.drawn_differently =
            fmt::format("{} in the baseline, {} in the candidate", old_row.renderer, new_row.renderer);
    all.insert(all.end(), pairs.begin(), pairs.end());
    comparison.conditions.push_back(compare_pairs(condition, std::move(pairs)));
  }
  comparison.all = compare_pairs("all", std::move(all));
  if (!comparison.drawn_differently.empty()) {
    comparison.all.bit_for_bit = 0;
    for (ConditionComparison& condition : comparison.conditions) condition.bit_for_bit = 0;
  }
  comparison.missing = without_partner(baseline, new_rows);
  comparison.added = without_partner(candidate, old_rows);
  comparison.baseline_failed = failed_to_run(baseline);
  comparison.candidate_failed = failed_to_run(candidate);
  return comparison;
}

ComparedCampaign read_compared(const std::filesystem::path& folder) {
  const CampaignFolder held{folder};
  return {held, read_campaign(held), read_campaign_rows(folder)};
}

std::optional<std::string> drawn_differently(const Campaign& baseline, const Campaign& candidate) {
  if (baseline.pictures.empty() || candidate.pictures.empty()) return {};
  for (const auto& [scenery, digest] : baseline.pictures)
    for (const auto& [other, other_digest] : candidate.pictures)
      if (scenery == other && digest != other_digest)
        return fmt::format("{} scenery is drawn with pictures {} in the baseline, {} in the candidate",
                           scenery, digest, other_digest);
  return "";
}

std::string flights_text(std::size_t count) {
  return count == 1 ? "1 flight" : fmt::format("{} flights", count);
}

std::string names_text(const std::vector<FlightRow>& rows) {
  return some_of(rows, [](const FlightRow& row) {
    return row.flown() ? row.id : fmt::format("{} ({})", row.id, row.reason);
  });
}

void require_known_figures(const GateRule& rule) {
  std::vector<std::string> known;
  for (const Metric& metric : metrics) known.emplace_back(metric.name);
  for (const Tolerance& tolerance : rule.tolerances)
    if (std::ranges::find(known, tolerance.figure) == known.end())
      throw ScenarioError(fmt::format("--tolerate {}: must be one of {}{}", tolerance.figure,
                                      fmt::join(known, ", "), did_you_mean(tolerance.figure, known)));
}

std::string GateVerdict::name() const {
  return std::string(verdict_names[static_cast<std::size_t>(verdict)].first);
}

Verdict verdict_on(const GateCounts& counts, const GateRule& rule) {
  const double enough = -std::log(rule.alpha);
  const auto of_fall = [](const SignCounts& signs, double by) {
    return std::exp(log_evidence_above(signs.mirrored(), by));
  };
  const auto mean_of_conditions = [&](double by) {
    double sum = 0;
    for (const SignCounts& condition : counts.conditions) sum += of_fall(condition, by);
    return sum / static_cast<double>(std::max<std::size_t>(1, counts.conditions.size()));
  };
  if (std::log(mean_of_conditions(rule.margin) / 2) >= enough) return Verdict::worse;
  if (log_evidence_above(counts.all, -rule.margin) >= enough) return Verdict::not_worse;
  const double evidence = (of_fall(counts.all, 0) + mean_of_conditions(0)) / 2;
  return std::log(evidence) >= enough ? Verdict::worse : Verdict::undecided;
}

GateVerdict verdict_on(const Comparison& comparison, const GateRule& rule) {
  GateVerdict verdict;
  const ConditionComparison& all = comparison.all;
  const GateCounts counts = counts_of(comparison);
  const int pairs = all.goals.pairs();
  verdict.difference = {sequential_lower_end(counts.all, rule.alpha),
                        -sequential_lower_end(counts.all.mirrored(), rule.alpha)};
  verdict.largest_fall = std::max(0.0, -verdict.difference.minimum);
  verdict.smallest_shown = smallest_shown(counts, rule);
  if (!comparison.candidate_failed.empty())
    verdict.reasons.push_back(fmt::format("{} of the candidate failed to run: {}",
                                          flights_text(comparison.candidate_failed.size()),
                                          names_text(comparison.candidate_failed)));
  if (!comparison.missing.empty())
    verdict.reasons.push_back(fmt::format("{} of the baseline missing in the candidate: {}",
                                          flights_text(comparison.missing.size()),
                                          names_text(comparison.missing)));
  if (pairs == 0) verdict.reasons.emplace_back("no flight of the two campaigns can be compared");
  const bool may_be_judged = verdict.reasons.empty();
  if (!may_be_judged) {
    verdict.verdict = Verdict::worse;
  } else if (all.bit_for_bit == pairs) {
    verdict.verdict = Verdict::unchanged;
    std::set<std::uint64_t> seeds;
    for (const FlightPair& pair : all.pairs) seeds.insert(pair.baseline.seed);
    verdict.changed_at_most = none_seen_upper_end(static_cast<int>(seeds.size()), rule.alpha);
  } else {
    verdict.verdict = verdict_on(counts, rule);
    if (verdict.verdict == Verdict::worse) verdict.reasons.push_back(reason_of_fall(comparison));
    if (verdict.verdict == Verdict::undecided) verdict.more_pairs = pairs_missing(counts, rule);
  }
  if (may_be_judged && verdict.verdict != Verdict::unchanged)
    for (const Tolerance& tolerance : rule.tolerances) judge(tolerance, all, verdict);
  return verdict;
}

int planned_pairs(double discordance, double power, const GateRule& rule) {
  constexpr int runs = 1000, step = 10, most = 20'000;
  std::mt19937_64 generator(1);
  std::vector<double> ends;
  for (int run = 0; run < runs; ++run) {
    SignCounts signs;
    while (signs.total() < most) {
      for (int i = 0; i < step; ++i) {
        const double drawn = static_cast<double>(generator() >> 11) * 0x1p-53;
        (drawn < discordance / 2 ? signs.up : drawn < discordance ? signs.down : signs.even) += 1;
      }
      if (log_evidence_above(signs, -rule.margin) >= -std::log(rule.alpha)) break;
    }
    ends.push_back(signs.total());
  }
  const auto pairs = static_cast<int>(quantile(ends, power));
  return pairs < most ? pairs : 0;
}

}  // namespace understory
