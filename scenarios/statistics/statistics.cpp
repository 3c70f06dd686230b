#include "scenarios/statistics/statistics.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>

namespace understory {
namespace {

/// Newcombe's phi: the correlation of the pairs, where positive drawn towards 0 by n/2.
double correlation(const PairedOutcomes& outcomes) {
  const double n = outcomes.pairs(), first = outcomes.first(), second = outcomes.second();
  const double margins = first * (n - first) * second * (n - second);
  if (margins == 0) return 0;
  double product = static_cast<double>(outcomes.both) * outcomes.neither -
                   static_cast<double>(outcomes.only_first) * outcomes.only_second;
  if (product > 0) product = std::max(product - 0.5 * n, 0.0);
  return product / std::sqrt(margins);
}

/// How far a difference reaches, from how far its two shares do.
double reach(double of_one, double of_other, double phi) {
  return std::sqrt(of_one * of_one - 2 * phi * of_one * of_other + of_other * of_other);
}

/// That `throws` of a fair coin show at most `heads` heads.
double at_most_heads(int heads, int throws) {
  double probability = 0;
  for (int k = 0; k <= heads; ++k)
    probability += std::exp(std::lgamma(throws + 1) - std::lgamma(k + 1) - std::lgamma(throws - k + 1) -
                            throws * std::numbers::ln2);
  return probability;
}

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// By Newton's steps from the middle: the cumulative distribution is convex below it, so that none
/// overshoots.
double normal_quantile(double share) {
  if (share > 0.5) return -normal_quantile(1 - share);
  double z = 0, step = 1;
  while (std::abs(step) > 1e-14 * (1 + std::abs(z))) {
    step = (share - normal_cdf(z)) * std::sqrt(2 * std::numbers::pi) * std::exp(0.5 * z * z);
    z += step;
  }
  return z;
}

/// Below `count`. std::uniform_int_distribution may differ from library to library; this does not. Its bias,
/// count / 2^32, is far below what resampling can tell.
std::size_t draw_below(std::size_t count, std::mt19937_64& generator) {
  return static_cast<std::size_t>(((generator() >> 32) * count) >> 32);
}

std::vector<double> resampled_values(std::span<const double> sample, const Statistic& statistic,
                                     const BootstrapOptions& options) {
  std::mt19937_64 generator(options.seed);
  std::vector<double> values, resample(sample.size());
  values.reserve(static_cast<std::size_t>(options.resamples));
  for (int i = 0; i < options.resamples; ++i) {
    for (double& value : resample) value = sample[draw_below(sample.size(), generator)];
    values.push_back(statistic(resample));
  }
  std::ranges::sort(values);
  return values;
}

/// Equation 14.15: the skewness of the values that come out with one of the sample left out.
double acceleration(std::span<const double> sample, const Statistic& statistic) {
  std::vector<double> values;
  for (std::size_t left_out = 0; left_out < sample.size(); ++left_out) {
    std::vector<double> rest(sample.begin(), sample.end());
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left_out));
    values.push_back(statistic(rest));
  }
  const double mean = mean_of(values);
  double squares = 0, cubes = 0;
  for (const double value : values) {
    squares += (mean - value) * (mean - value);
    cubes += (mean - value) * (mean - value) * (mean - value);
  }
  return squares == 0 ? 0 : cubes / (6 * squares * std::sqrt(squares));
}

/// Equation 14.14, equal values counted half (a mean of few values takes few): how far off the middle the
/// resamples lie, as a normal quantile.
double bias_correction(const std::vector<double>& sorted, double value) {
  const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
  const auto count = static_cast<double>(sorted.size());
  const double below = 0.5 * static_cast<double>((first - sorted.begin()) + (last - sorted.begin()));
  return normal_quantile(std::clamp(below, 0.5, count - 0.5) / count);
}

/// Equations 14.9 and 14.10: the end that belongs to the normal quantile `z`.
double bca_end(const std::vector<double>& sorted, double z, double bias, double accelerated) {
  const double slowed = 1 - accelerated * (bias + z);
  double share = z > 0 ? 1 : 0;  // beyond the correction's reach: all there is
  if (slowed > 0) share = normal_cdf(bias + (bias + z) / slowed);
  const double rank = std::floor((static_cast<double>(sorted.size()) + 1) * share);
  return sorted[static_cast<std::size_t>(std::clamp(rank, 1.0, static_cast<double>(sorted.size()))) - 1];
}

/// What happened at one distance.
struct Leaving {
  int ended = 0;
  int censored = 0;
};

std::map<double, Leaving> by_distance(const std::vector<Lifetime>& lifetimes) {
  std::map<double, Leaving> leaving;
  for (const Lifetime& lifetime : lifetimes) {
    Leaving& here = leaving[lifetime.at];
    (lifetime.ended ? here.ended : here.censored) += 1;
  }
  return leaving;
}

/// `greenwood`: the sum of d / (n (n - d)), the variance of log(share).
Interval log_log_interval(double share, double greenwood) {
  const double error = z_95 * std::sqrt(greenwood) / std::abs(std::log(share));
  return {std::pow(share, std::exp(error)), std::pow(share, std::exp(-error))};
}

}  // namespace

Interval poisson_interval(int events) {
  constexpr double tail = 0.025;
  return {events > 0 ? boost::math::gamma_p_inv(events, tail) : 0,
          boost::math::gamma_p_inv(events + 1, 1 - tail)};
}

Interval wilson_interval(int successes, int trials) {
  if (trials == 0) return {0, 1};
  constexpr double z = z_95;
  const double n = trials;
  const double share = successes / n;
  const double scale = 1 / (1 + z * z / n);
  const double centre = scale * (share + z * z / (2 * n));
  const double half = scale * z * std::sqrt(share * (1 - share) / n + z * z / (4 * n * n));
  return {centre - half, centre + half};
}

double mcnemar_exact_p(const PairedOutcomes& outcomes) {
  const int changed = outcomes.only_first + outcomes.only_second;
  if (changed == 0) return 1;
  return std::min(1.0, 2 * at_most_heads(std::min(outcomes.only_first, outcomes.only_second), changed));
}

Interval paired_difference_interval(const PairedOutcomes& outcomes) {
  const int n = outcomes.pairs();
  if (n == 0) return {-1, 1};
  const double first = static_cast<double>(outcomes.first()) / n;
  const double second = static_cast<double>(outcomes.second()) / n;
  const Interval of_first = wilson_interval(outcomes.first(), n);
  const Interval of_second = wilson_interval(outcomes.second(), n);
  const double phi = correlation(outcomes);
  const double difference = outcomes.difference();
  return {difference - reach(second - of_second.minimum, of_first.maximum - first, phi),
          difference + reach(of_second.maximum - second, first - of_first.minimum, phi)};
}

double mean_of(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(q * static_cast<double>(values.size()))) - 1;
  const auto place = values.begin() + std::clamp<std::ptrdiff_t>(rank, 0, std::ssize(values) - 1);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

BootstrapEstimate bootstrap(std::span<const double> sample, const Statistic& statistic,
                            const BootstrapOptions& options) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (sample.empty()) return {unknown, {-infinity, infinity}};
  const double value = statistic(sample);
  if (sample.size() == 1) return {value, {-infinity, infinity}};

  const std::vector<double> values = resampled_values(sample, statistic, options);
  const double bias = bias_correction(values, value);
  const double accelerated = acceleration(sample, statistic);
  return {value,
          {bca_end(values, -options.z, bias, accelerated), bca_end(values, options.z, bias, accelerated)}};
}

SurvivalCurve kaplan_meier(const std::vector<Lifetime>& lifetimes) {
  int at_risk = static_cast<int>(lifetimes.size());
  SurvivalCurve curve;
  curve.steps.push_back({0, 1, wilson_interval(at_risk, at_risk)});
  double greenwood = 0;
  for (const auto& [at, leaving] : by_distance(lifetimes)) {
    curve.last_at = at;
    if (leaving.ended > 0) {
      const SurvivalStep& before = curve.steps.back();
      const double staying = at_risk - leaving.ended;
      SurvivalStep step{at, before.share * staying / at_risk, {0, before.interval.maximum}};
      if (staying > 0) {
        greenwood += leaving.ended / (at_risk * staying);
        step.interval = log_log_interval(step.share, greenwood);
      }
      curve.steps.push_back(step);
    }
    at_risk -= leaving.ended + leaving.censored;
  }
  return curve;
}

std::optional<double> median_survival(const SurvivalCurve& curve) {
  // Shares are products of fractions: half may come out a few units of the last place above 0.5.
  for (const SurvivalStep& step : curve.steps)
    if (step.share <= 0.5 + 1e-12) return step.at;
  return {};
}

}  // namespace understory
