#pragma once

#include <optional>
#include <vector>

#include "scenarios/statistics/proportions.hpp"

namespace understory {

/// How far (long, ...) one subject was watched, and whether it ended there or was last seen well: censored.
struct Lifetime {
  double at = 0;
  bool ended = false;
};

/// From `at` until the next step.
struct SurvivalStep {
  double at = 0;
  double share = 1;
  Interval interval;  ///< 95 %
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

/// The shortest distance by which half have ended; nothing where more than half got through.
std::optional<double> median_survival(const SurvivalCurve& curve);

}  // namespace understory
