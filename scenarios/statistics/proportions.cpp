#include "scenarios/statistics/proportions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

}  // namespace

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

}  // namespace understory
