#pragma once

#include <string>
#include <vector>

#include "scenarios/campaign/comparison.hpp"

namespace understory {

struct GateRule {
  double max_drop = 0.05;  ///< share of goals, 0 .. 1, that any condition may lose
};

/// Whether a change may pass.
///
/// It may not where
/// - in any condition the share of goals, over the pairs both flown, fell by more than max_drop. What counts
/// is
///   what was measured, not what it proves: p and interval are printed beside it. A rule on p would let any
///   drop pass that is measured with few enough seeds, and one on the interval's end would fail nearly every
///   change. So the number of seeds decides how often chance trips it: where a share r of n pairs changes
///   outcome either way, the drop deviates by sqrt(r / n), 3 points for 100 seeds of which a tenth change;
///   then one change in 20 that is worth nothing loses more than 5. Flights repeat bit for bit: an unchanged
///   program never trips it;
/// - a flight of the candidate failed to run: crashed, hung, was killed or refused;
/// - a flight of the baseline is missing in the candidate: else dropping the hard seeds would pass;
/// - no flight of the two campaigns could be compared.
/// The overall share cannot fall by more than max_drop where no condition's does, and is not asked.
/// Conditions and seeds that only the candidate has decide nothing, nor do flights that failed in the
/// baseline.
struct GateVerdict {
  std::vector<std::string> reasons;  ///< why not, a line each

  bool passes() const { return reasons.empty(); }
};

GateVerdict judge(const Comparison& comparison, const GateRule& rule = {});

/// Whether this condition fell by more than the rule allows; exact at the edge: 5 of 100 are not more than
/// 0.05.
bool dropped_too_far(const ConditionComparison& condition, const GateRule& rule);

/// For a person at a CI log: success per condition with intervals, p and difference; the other figures of
/// conditions in which any flight changed; the seeds that got worse and better; what could not be compared;
/// the verdict last.
std::string to_report(const Comparison& comparison, const GateVerdict& verdict, const GateRule& rule);

}  // namespace understory
