#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace understory {

/// A count out of a total.
struct Share {
  std::int64_t of = 0;
  std::int64_t with = 0;

  void count(bool has) {
    ++of;
    with += has;
  }
  void add(const Share& other) {
    of += other.of;
    with += other.with;
  }
  /// 0 .. 1; 0 if `of` is 0.
  double value() const { return of > 0 ? static_cast<double>(with) / static_cast<double>(of) : 0; }
};

struct Interval {
  double minimum = 0;
  double maximum = 1;
};

/// The normal quantile of 95 % intervals: what every interval of this folder has unless it says otherwise.
inline constexpr double z_95 = 1.959963984540054;

/// Wilson's score interval for a proportion (Wilson 1927, J. Am. Stat. Assoc. 22), 95 %, without continuity
/// correction. No trials: 0 .. 1.
Interval wilson_interval(int successes, int trials);

/// Garwood's exact 95 % interval for the mean of a Poisson count (Garwood 1936, Biometrika 28, 437), from
/// quantiles of the gamma distribution. After no event it begins at 0.
Interval poisson_interval(int events);

/// The same trials made twice, each time good or bad: how often both were good, only one, none.
struct PairedOutcomes {
  int both = 0;
  int only_first = 0;
  int only_second = 0;
  int neither = 0;

  void count(bool first_is_good, bool second_is_good) {
    ++(first_is_good ? (second_is_good ? both : only_first) : (second_is_good ? only_second : neither));
  }
  int pairs() const { return both + only_first + only_second + neither; }
  int first() const { return both + only_first; }
  int second() const { return both + only_second; }
  /// Share of the second less share of the first; 0 without pairs.
  double difference() const {
    return pairs() == 0 ? 0 : static_cast<double>(only_second - only_first) / pairs();
  }
};

/// Two-sided p value that both shares are the same: the exact form of McNemar's test (McNemar 1947,
/// Psychometrika 12), in which the pairs that changed split as a fair coin would. 1 where none changed. It is
/// conservative with few changed pairs: with five it cannot fall below 0.0625.
double mcnemar_exact_p(const PairedOutcomes& outcomes);

/// 95 % interval of difference(): Newcombe's method 10 (Newcombe 1998, Statistics in Medicine 17, 2635),
/// Wilson intervals of both shares put together with the correlation of the pairs, corrected for continuity.
/// -1 .. 1 without pairs.
Interval paired_difference_interval(const PairedOutcomes& outcomes);

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
/// interval is that value: it knows only what was seen. Below about 15 values it is too narrow.
BootstrapEstimate bootstrap(std::span<const double> sample, const Statistic& statistic = mean_of,
                            const BootstrapOptions& options = {});

/// How far (long, ...) one subject was watched, and whether it ended there; if not, it is censored there.
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
  double last_at = 0;  ///< nobody was watched beyond: the curve ends there
};

/// The share that gets beyond each distance (Kaplan & Meier 1958, J. Am. Stat. Assoc. 53), with Greenwood's
/// variance and the interval of log(-log share) (Kalbfleisch & Prentice 1980), which stays within 0 and 1.
/// A subject censored where another ends counts as at risk there. Where those formulas are undefined: before
/// the first ending the interval is Wilson's for n of n, and after the last subject has ended it reaches from
/// 0 to the end of the step before. Without lifetimes: one step, 0 .. 1.
SurvivalCurve kaplan_meier(const std::vector<Lifetime>& lifetimes);

/// The shortest distance by which half have ended; nothing where more than half got through.
std::optional<double> median_survival(const SurvivalCurve& curve);

}  // namespace understory
