#pragma once

#include <string>
#include <vector>

#include "scenarios/campaign/flight_row.hpp"
#include "scenarios/statistics/proportions.hpp"
#include "scenarios/statistics/samples.hpp"

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
  std::string condition;          ///< "all" where it is all of them
  std::vector<FlightPair> pairs;  ///< by seed
  PairedOutcomes goals;           ///< of pairs both flown; first: baseline, second: candidate
  double p = 1;                   ///< McNemar's, that both succeed alike
  Interval difference;            ///< 95 %, of the share of goals: candidate less baseline
  std::vector<MetricComparison> metrics;
  int bit_for_bit = 0;  ///< pairs with the same digest: nothing that a flight can feel has changed
};

/// Two campaigns, paired by condition and seed. A flight that failed to run on either side enters no figure:
/// a program that broke says nothing about how well it avoids trees. It is listed instead.
struct Comparison {
  std::vector<ConditionComparison> conditions;  ///< those with a pair, in the baseline's order
  ConditionComparison all;
  std::vector<FlightRow> missing;          ///< in the baseline only
  std::vector<FlightRow> added;            ///< in the candidate only
  std::vector<FlightRow> baseline_failed;  ///< failed to run, in either set, paired or not
  std::vector<FlightRow> candidate_failed;
  /// Conditions of one name that were asked another speed, density or goal: their difference is not the
  /// program's alone.
  std::vector<std::string> altered;
};

/// Throws ScenarioError where a set has a seed of a condition twice.
Comparison compare_campaigns(const std::vector<FlightRow>& baseline, const std::vector<FlightRow>& candidate);

}  // namespace understory
