#include "scenarios/statistics/samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace understory {
namespace {

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
  const auto [first, last] = std::ranges::equal_range(sorted, value);
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

}  // namespace

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

}  // namespace understory
