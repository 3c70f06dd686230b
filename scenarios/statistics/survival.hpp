#pragma once

#include <optional>
#include <vector>

#include "scenarios/statistics/interval.hpp"

namespace understory {

/// How far (long, ...) one subject was watched, and whether it ended there or was last seen well: censored.
struct Lifetime {
  double at = 0;
  bool ended = false;
};

/// From `at` until the next step.
struct SurvivalStep {
  double at = 0;
  int at_risk = 0;  ///< watched up to here
  int ended = 0;    ///< of those, here
  double share = 1;
  double standard_error = 0;  ///< Greenwood's
  Interval interval;          ///< 95 %
};

/// A step at 0, then one wherever a subject ended.
struct SurvivalCurve {
  std::vector<SurvivalStep> steps;
  double last_at = 0;  ///< nobody was watched beyond: the curve says nothing there
};

/// The share that gets beyond each distance (Kaplan & Meier 1958, J. Am. Stat. Assoc. 53), with Greenwood's
/// variance and the interval of log(-log share) (Kalbfleisch & Prentice 1980), which stays within 0 and 1.
/// Who is censored where another ends counts as at risk there. Where those formulas say nothing: before the
/// first ending the interval is Wilson's for n of n, and after the last subject has ended it reaches from 0
/// to the end of the step before. Without lifetimes: one step, 0 .. 1.
SurvivalCurve kaplan_meier(const std::vector<Lifetime>& lifetimes);

/// The step that holds at `at` (>= 0).
const SurvivalStep& survival_at(const SurvivalCurve& curve, double at);

/// The shortest distance by which half have ended; nothing where more than half got through.
std::optional<double> median_survival(const SurvivalCurve& curve);

/// Whether two groups' curves are one: the log-rank test (Mantel 1966; Peto & Peto 1972) with the
/// hypergeometric variance, chi-square with one degree of freedom.
struct LogRank {
  double expected_first = 0;  ///< endings the first group would have had, were they one
  double expected_second = 0;
  double chi_square = 0;
  double p = 1;
};
LogRank log_rank(const std::vector<Lifetime>& first, const std::vector<Lifetime>& second);

}  // namespace understory
