#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "scenarios/statistics/proportions.hpp"

namespace understory {

/// A figure of a sample: its mean, its variance.
using Statistic = std::function<double(std::span<const double>)>;

double mean_of(std::span<const double> values);

/// The q-th part (0 .. 1) of `values` lies at or below this one; 0 for no values. Nearest rank.
double quantile(std::vector<double> values, double q);

struct BootstrapOptions {
  int resamples = 10'000;  ///< Efron & Tibshirani 1993, 14.3: at least 1000 for an interval
  std::uint64_t seed = 1;  ///< of its own generator: the same values give the same interval
  double z = z_95;         ///< normal quantile of the interval's ends: 1.644854 for 90 %
};

/// In the unit of the statistic.
struct BootstrapEstimate {
  double value = 0;  ///< of the sample itself; NaN where it is empty
  Interval interval;
};

/// The nonparametric bootstrap with the BCa interval (bias-corrected and accelerated: Efron 1987, J. Am.
/// Stat. Assoc. 82; Efron & Tibshirani 1993, An Introduction to the Bootstrap, 14.3), acceleration by
/// jackknife. For a paired comparison the sample is the pairs' differences. Fewer than two values say nothing
/// about their spread: the interval is -infinity .. infinity. Where all values are the same the
/// interval is that value: it knows only what was seen. Below about 15 values it is narrower than it says.
BootstrapEstimate bootstrap(std::span<const double> sample, const Statistic& statistic = mean_of,
                            const BootstrapOptions& options = {});

}  // namespace understory
