#include "scenarios/statistics/paired_outcomes.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>

#include "scenarios/statistics/wilson.hpp"

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

}  // namespace

double mcnemar_exact_p(const PairedOutcomes& outcomes) {
  const int changed = outcomes.only_first + outcomes.only_second;
  if (changed == 0) return 1;
  const boost::math::binomial_distribution<double> coin(changed, 0.5);
  return std::min(1.0, 2 * boost::math::cdf(coin, std::min(outcomes.only_first, outcomes.only_second)));
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
