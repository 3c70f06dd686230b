#pragma once

#include <string>
#include <vector>

#include "scenarios/statistics/proportions.hpp"
#include "scenarios/tuning/tuning.hpp"

namespace understory {

/// One figure on validation data: the tuned configuration less the scenario as it is.
struct FigureChange {
  double difference = 0;
  Interval interval;  ///< 95 %; -infinity .. infinity where the data cannot say
};

/// In the figures' order; empty where either was refused. Units (recordings, flights) are drawn in pairs,
/// with replacement, and their counts put together (BCa bootstrap). Success of flights is the exception:
/// Newcombe's interval for paired shares.
std::vector<FigureChange> changes_on_validation(const TuneFile& file, const Tuned& tuned,
                                                const Judge& validation);

/// Flights only: which seeds reached the goal; first: the scenario, second: the tuned one.
PairedOutcomes paired_goals(const Tuned& tuned);

/// The unit's own 95 % interval of a share of flights at the goal (Wilson).
Interval success_interval(const std::vector<Counts>& flights);

}  // namespace understory
