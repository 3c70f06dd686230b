#pragma once

#include "scenarios/statistics/statistics.hpp"

/// Tests and intervals that may be looked at after every pair: a verdict that is taken as soon as it can be
/// taken errs no more often than it says.
///
/// Values of -1, 0 and 1 arrive one after the other, each with the same mean, whatever came before. Whoever
/// believes that the mean is at most `null` offers a fair game: a bet of a share `s` of the largest possible
/// stake multiplies the money by 1 + s (value - null) / (1 + null). By Ville's inequality (Ville 1939) money
/// that began as 1 ever reaches 1 / alpha with a probability of at most alpha, if the belief is true. The
/// money is laid evenly on bets of 1/20, 2/20 ... 20/20, so it depends on the counts alone and not on their
/// order. Waudby-Smith & Ramdas 2024 (J. R. Stat. Soc. B 86, 1, "Estimating means of bounded random variables
/// by betting") prove this for bounded values, and the confidence sequence that follows from it.
namespace understory {

/// How many values were 1, 0 and -1. A forecast has parts of values.
struct SignCounts {
  double up = 0, even = 0, down = 0;

  double total() const { return up + even + down; }
  SignCounts mirrored() const { return {down, even, up}; }
};

/// Gains of the second over the first: up.
SignCounts signs_of(const PairedOutcomes& outcomes);

/// Natural logarithm of the money against a mean of at most `null` (-1 < null < 1): evidence that it is
/// higher.
double log_evidence_above(const SignCounts& counts, double null);

/// The mean lies above this one: with probability 1 - alpha at every look together. -1 without values.
double sequential_lower_end(const SignCounts& counts, double alpha);

/// At most this share of trials has a property that none of `trials` had: with probability 1 - alpha at every
/// look together (all money on the largest bet).
double none_seen_upper_end(int trials, double alpha);

}  // namespace understory
