#pragma once

#include <string>
#include <vector>

#include "scenarios/campaign/flight_row.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace understory {

/// The same condition and seed in both campaigns.
struct FlightPair {
  FlightRow baseline;
  FlightRow candidate;

  bool flown() const { return baseline.flown() && candidate.flown(); }
  bool got_worse() const { return flown() && baseline.reached_goal() && !candidate.reached_goal(); }
  bool got_better() const { return flown() && !baseline.reached_goal() && candidate.reached_goal(); }
};

/// One figure over the pairs in which both flights were flown and have it.
struct MetricComparison {
  std::string name;  ///< of FlightRow's field, its unit at the end
  int pairs = 0;
  double baseline_mean = 0;
  double candidate_mean = 0;
  BootstrapEstimate difference;  ///< candidate less baseline
};

/// Pairs of one condition, or of all.
struct ConditionComparison {
  std::string condition;          ///< "all" for all of them
  std::vector<FlightPair> pairs;  ///< by seed
  PairedOutcomes goals;           ///< of pairs both flown; first: baseline, second: candidate
  double p = 1;                   ///< McNemar's, that both succeed alike
  Interval difference;            ///< 95 %, of the share of goals: candidate less baseline
  std::vector<MetricComparison> metrics;
  int bit_for_bit = 0;  ///< pairs with the same digest: nothing that affects a flight has changed
};

/// Two campaigns, paired by condition and seed. A flight that failed to run on either side counts in no
/// figure: a program that failed says nothing about how well it avoids trees. It is listed instead.
struct Comparison {
  std::vector<ConditionComparison> conditions;  ///< those with a pair, in the baseline's order
  ConditionComparison all;
  std::vector<FlightRow> missing;          ///< in the baseline only
  std::vector<FlightRow> added;            ///< in the candidate only
  std::vector<FlightRow> baseline_failed;  ///< failed to run, in either set, paired or not
  std::vector<FlightRow> candidate_failed;
  /// Conditions of one name with another speed, density or goal in the two sets: their difference is not due
  /// to the program alone.
  std::vector<std::string> altered;
  /// "A in the baseline, B in the candidate", where flights of a pair were drawn by different renderers.
  std::string drawn_differently;
};

/// Throws ScenarioError where a set has a seed of a condition twice.
Comparison compare_campaigns(const std::vector<FlightRow>& baseline, const std::vector<FlightRow>& candidate);

struct GateRule {
  double max_drop = 0.05;  ///< share of goals, 0 .. 1, that any condition may lose
};

/// Whether a change may pass.
///
/// It may not if
/// - in any condition the share of goals, over the pairs both flown, fell by more than max_drop. The rule
///   uses the measured drop, not its significance: p and interval are printed beside it. A rule on p would
///   let any drop pass that is measured with few enough seeds, and one on the interval's end would fail
///   nearly every change. So the number of seeds decides how often chance fails a change: if a share r of n
///   pairs changes outcome either way, the drop has a deviation of sqrt(r / n), 3 points for 100 seeds of
///   which a tenth change; then one in 20 changes without effect loses more than 5 points. Flights repeat bit
///   for bit, so an unchanged program never fails;
/// - a flight of the candidate failed to run: crashed, hung, was killed or refused;
/// - a flight of the baseline is missing in the candidate: else dropping the hard seeds would pass;
/// - no flight of the two campaigns could be compared.
/// The overall share cannot fall by more than max_drop if no condition's does, so it is not tested.
/// Conditions and seeds that only the candidate has decide nothing, nor do flights that failed in the
/// baseline.
struct GateVerdict {
  std::vector<std::string> reasons;  ///< why not, a line each

  bool passes() const { return reasons.empty(); }
};

GateVerdict verdict_on(const Comparison& comparison, const GateRule& rule = {});

/// Whether this condition fell by more than the rule allows; exact at the edge: 5 of 100 are not more than
/// 0.05.
bool dropped_too_far(const ConditionComparison& condition, const GateRule& rule);

/// For a person at a CI log: success per condition with intervals, p and difference; the other figures of
/// conditions in which any flight changed; the seeds that got worse and better; what could not be compared;
/// the verdict last.
std::string to_report(const Comparison& comparison, const GateVerdict& verdict, const GateRule& rule);

/// Flights as JUnit XML, which every CI server shows: a test suite per condition, in order of appearance, a
/// test case per flight; classname: the condition, name: the seed, time: simulated seconds. Each suite has
/// the program's version as a property. What XML 1.0 cannot hold (control characters, broken UTF-8) is
/// written as '?'. A flight that did not reach its goal is a <failure>, one that failed to run an <error>.
std::string campaign_junit(const std::vector<FlightRow>& rows);

/// The gate's comparison: a flight that reached its goal in the baseline and does not any more is a
/// <failure>; one that failed to run or is missing in the candidate an <error>; flights only the candidate
/// has pass. A suite "gate" has a test case per condition, which fails where it lost more than the rule
/// allows. A server that calls a build broken for any <failure> is stricter than the gate, whose exit status
/// is its verdict.
std::string gate_junit(const Comparison& comparison, const GateRule& rule = {});

}  // namespace understory
