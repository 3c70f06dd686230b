#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "scenarios/campaign/campaign_summary.hpp"
#include "scenarios/campaign/gate.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/report/table.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(double share) { return fmt::format("{:.1f}", 100 * share); }
std::string signed_percent(double share) { return fmt::format("{:+.1f}", 100 * share); }

std::string success_text(int goals, int flights) {
  const Interval interval = wilson_interval(goals, flights);
  return fmt::format("{} ({} to {})", goals, percent(interval.minimum), percent(interval.maximum));
}

/// Of the flights of one side that have a pair.
ConditionSummary summary_of_side(const ConditionComparison& condition, FlightRow FlightPair::*side) {
  std::vector<FlightRow> rows;
  for (const FlightPair& pair : condition.pairs) rows.push_back(pair.*side);
  return rows.empty() ? ConditionSummary() : summary_of(rows);
}

std::string between_crashes(const ConditionComparison& condition, FlightRow FlightPair::*side) {
  return crash_distance_text(summary_of_side(condition, side));
}

void add_success(const ConditionComparison& condition, Table& table) {
  const PairedOutcomes& goals = condition.goals;
  table.add(
      condition.condition, goals.pairs(), success_text(goals.first(), goals.pairs()),
      success_text(goals.second(), goals.pairs()),
      fmt::format("{} ({} to {})", signed_percent(goals.difference()),
                  signed_percent(condition.difference.minimum), signed_percent(condition.difference.maximum)),
      goals.only_first, goals.only_second, fmt::format("{:.3g}", condition.p), condition.bit_for_bit,
      between_crashes(condition, &FlightPair::baseline), between_crashes(condition, &FlightPair::candidate));
}

Table success_table(const Comparison& comparison) {
  Table table{{"success, %", "pairs", "baseline goals", "candidate goals", "difference", "worse", "better",
               "p", "bit for bit", "baseline km/crash", "candidate km/crash"}};
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

/// The pairs whose outcome changed for the worse, or for the better.
std::vector<FlightPair> changed(const ConditionComparison& condition, bool worse) {
  std::vector<FlightPair> pairs;
  std::ranges::copy_if(condition.pairs, std::back_inserter(pairs), [worse](const FlightPair& pair) {
    return worse ? pair.got_worse() : pair.got_better();
  });
  return pairs;
}

std::string ending_of(const FlightRow& row) {
  return fmt::format("{} at {:.1f} m", row.outcome, row.progress_m);
}

std::string changed_seeds(const ConditionComparison& condition, bool worse) {
  const std::vector<FlightPair> pairs = changed(condition, worse);
  if (pairs.empty()) return "";
  return fmt::format("got {}: {}: seed {}\n", worse ? "worse" : "better", condition.condition,
                     some_of(pairs, [worse](const FlightPair& pair) {
                       const FlightRow& bad = worse ? pair.candidate : pair.baseline;
                       return fmt::format("{} ({}{})", bad.seed, worse ? "" : "before: ", ending_of(bad));
                     }));
}

/// What a reader must know of the comparison beside its figures.
std::vector<std::string> notes_of(const Comparison& comparison) {
  std::vector<std::string> notes;
  for (const std::string& condition : comparison.altered)
    notes.push_back(condition + "; the two were asked for different things");
  if (!comparison.drawn_differently.empty())
    notes.push_back("other renderers give other images, and so other flights; outcomes alone are compared: " +
                    comparison.drawn_differently);
  if (!comparison.added.empty())
    notes.push_back(fmt::format("{} of the candidate not in the baseline: {}",
                                flights_text(comparison.added.size()), names_text(comparison.added)));
  if (!comparison.baseline_failed.empty())
    notes.push_back(fmt::format("{} of the baseline failed to run: {}",
                                flights_text(comparison.baseline_failed.size()),
                                names_text(comparison.baseline_failed)));
  return notes;
}

std::string shown_text(const GateVerdict& verdict, int pairs) {
  if (verdict.smallest_shown > 1) return "With so few pairs, no loss would be called worse";
  return fmt::format("A net loss of {:.0f} of these pairs ({} points) would be called worse",
                     verdict.smallest_shown * pairs, percent(verdict.smallest_shown));
}

Json json_of(const Interval& interval) { return {interval.minimum, interval.maximum}; }

/// The interval is null after no kilometre; its upper end is null after no crash.
Json kilometres_of(const ConditionSummary& side) {
  Json json{{"flown", side.among_obstacles_km}, {"crashes", side.crashes()}, {"between_crashes", Json()}};
  if (side.among_obstacles_km > 0) json["between_crashes"] = json_of(crash_distance(side).interval);
  return json;
}

Json json_of(const ConditionComparison& condition) {
  const PairedOutcomes& goals = condition.goals;
  Json json{{"condition", condition.condition},
            {"pairs", goals.pairs()},
            {"baseline_goals", goals.first()},
            {"candidate_goals", goals.second()},
            {"worse", goals.only_first},
            {"better", goals.only_second},
            {"bit_for_bit", condition.bit_for_bit},
            {"difference", goals.difference()},
            {"interval", json_of(condition.difference)},
            {"p", condition.p},
            {"baseline_km", kilometres_of(summary_of_side(condition, &FlightPair::baseline))},
            {"candidate_km", kilometres_of(summary_of_side(condition, &FlightPair::candidate))},
            {"figures", Json::array()}};
  for (const MetricComparison& metric : condition.metrics)
    if (metric.pairs > 0)
      json["figures"].push_back({{"name", metric.name},
                                 {"pairs", metric.pairs},
                                 {"baseline", metric.baseline_mean},
                                 {"candidate", metric.candidate_mean},
                                 {"difference", metric.difference.value},
                                 {"interval", json_of(metric.difference.interval)}});
  return json;
}

Json with_seeds(Json json, const ConditionComparison& condition, const GateSides& sides) {
  for (const bool worse : {true, false}) {
    Json& list = json[worse ? "got_worse" : "got_better"] = Json::array();
    for (const auto& [baseline, candidate] : changed(condition, worse)) {
      list.push_back(
          {{"seed", candidate.seed}, {"baseline", baseline.outcome}, {"candidate", candidate.outcome}});
      if (sides.command) list.back()["command"] = sides.command(candidate);
    }
  }
  return json;
}

}  // namespace

std::string sentence_of(const Comparison& comparison, const GateVerdict& verdict, const GateRule& rule) {
  const int pairs = comparison.all.goals.pairs();
  const std::string margin = percent(rule.margin), shown = shown_text(verdict, pairs);
  const std::string known =
      verdict.difference.minimum > 0
          ? fmt::format("after {} pairs success has risen by {} percentage points at least", pairs,
                        percent(verdict.difference.minimum))
          : fmt::format("after {} pairs success may have fallen by {} percentage points at most", pairs,
                        percent(verdict.largest_fall));
  switch (verdict.verdict) {
    case Verdict::not_worse:
      return fmt::format("not worse: {}; a fall by {} is ruled out. {}.", known, margin, shown);
    case Verdict::unchanged:
      return fmt::format(
          "unchanged on these flights: all {} pairs are equal to the bit. With {:.0f} % confidence under {} "
          "% of other seeds would differ. {}.",
          pairs, 100 - 100 * rule.alpha, percent(verdict.changed_at_most), shown);
    case Verdict::worse:
      return fmt::format("worse: {}. {}.", fmt::join(verdict.reasons, "; "),
                         pairs == 0 ? "Nothing can be said of success" : shown);
    case Verdict::undecided:
      break;
  }
  const auto conditions = static_cast<int>(std::max<std::size_t>(1, comparison.conditions.size()));
  const int seeds = (verdict.more_pairs + conditions - 1) / conditions;
  const std::string more =
      verdict.more_pairs == 0
          ? "Nobody knows how many more would decide"
          : fmt::format("If more come out like these, about {} more pairs decide ({} seeds{})",
                        seeds * conditions, seeds,
                        conditions == 1 ? "" : fmt::format(" in each of {} conditions", conditions));
  // A tolerance may be what is undecided.
  const std::string open =
      verdict.largest_fall < rule.margin ? "ruled out" : "not ruled out, and no fall is shown";
  return fmt::format("not enough flights: {}; a fall by {} is {}. {}{}{}. {}.", known, margin, open,
                     fmt::join(verdict.reasons, ". "), verdict.reasons.empty() ? "" : ". ", more, shown);
}

std::string to_report(const Comparison& comparison, const GateVerdict& verdict, const GateRule& rule) {
  std::string text = to_text(success_table(comparison));
  text +=
      "  intervals 95 %: goals by Wilson, difference by Newcombe's paired method; p: McNemar's exact test. "
      "These hold for somebody who looks once; the verdict below holds at every look\n\n";
  const Table metrics = metric_table(comparison);
  if (!metrics.rows.empty())
    text +=
        to_text(metrics) +
        "  difference of paired flights, 95 % interval by BCa bootstrap (too narrow below some 15 pairs)\n\n";
  for (const bool worse : {true, false})
    for (const ConditionComparison& condition : comparison.conditions)
      text += changed_seeds(condition, worse);
  for (const std::string& note : notes_of(comparison)) text += "note: " + note + "\n";
  return text + sentence_of(comparison, verdict, rule) + "\n";
}

std::string to_markdown(const Comparison& comparison, const GateVerdict& verdict, const GateRule& rule,
                        const GateSides& sides) {
  const std::string sentence = sentence_of(comparison, verdict, rule);
  std::string text = fmt::format(
      "### Flights: {}\n\n{}{}\n\n{} against {}. Of harmless changes {:.0f} % at most are called worse, of "
      "those that cost {} points {:.0f} % at most not worse, however often somebody looks.\n\n{}\n",
      verdict.name(), static_cast<char>(std::toupper(sentence[0])), sentence.substr(1), sides.candidate,
      sides.baseline, 100 * rule.alpha, percent(rule.margin), 100 * rule.alpha,
      to_markdown(success_table(comparison)));
  std::string worse;
  for (const ConditionComparison& condition : comparison.conditions)
    for (const FlightPair& pair : changed(condition, true)) {
      worse +=
          fmt::format("- {} {}: {}", condition.condition, pair.candidate.seed, ending_of(pair.candidate));
      if (sides.command) worse += fmt::format("; `{}`", sides.command(pair.candidate));
      if (!sides.page.empty()) worse += fmt::format("; replay: {}#{}", sides.page, pair.candidate.id);
      worse += "\n";
    }
  if (!worse.empty()) text += "**Seeds that got worse**\n\n" + worse + "\n";
  const Table metrics = metric_table(comparison);
  if (!metrics.rows.empty())
    text += "<details><summary>Other figures</summary>\n\n" + to_markdown(metrics) + "\n</details>\n\n";
  for (const std::string& note : notes_of(comparison)) text += "Note: " + note + "\n\n";
  return text;
}

std::string to_json(const Comparison& comparison, const GateVerdict& verdict, const GateRule& rule,
                    const GateSides& sides) {
  Json json{{"verdict", verdict.name()},
            {"passes", verdict.passes()},
            {"sentence", sentence_of(comparison, verdict, rule)},
            {"reasons", verdict.reasons},
            {"baseline", sides.baseline},
            {"candidate", sides.candidate},
            {"margin", rule.margin},
            {"alpha", rule.alpha},
            {"difference", json_of(verdict.difference)},
            {"largest_fall", verdict.largest_fall},
            {"smallest_shown", verdict.smallest_shown > 1 ? Json() : Json(verdict.smallest_shown)},
            {"more_pairs", verdict.more_pairs},
            {"all", json_of(comparison.all)},
            {"conditions", Json::array()},
            {"notes", notes_of(comparison)}};
  if (verdict.verdict == Verdict::unchanged) json["changed_at_most"] = verdict.changed_at_most;
  for (const ConditionComparison& condition : comparison.conditions)
    json["conditions"].push_back(with_seeds(json_of(condition), condition, sides));
  return json_text(json, 1) + "\n";
}

}  // namespace understory
