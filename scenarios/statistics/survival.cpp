#include "scenarios/statistics/survival.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <map>

#include "scenarios/statistics/wilson.hpp"

namespace understory {
namespace {

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

int count_at_risk(const std::vector<Lifetime>& lifetimes, double at) {
  return static_cast<int>(
      std::ranges::count_if(lifetimes, [at](const Lifetime& lifetime) { return lifetime.at >= at; }));
}

}  // namespace

SurvivalCurve kaplan_meier(const std::vector<Lifetime>& lifetimes) {
  int at_risk = static_cast<int>(lifetimes.size());
  SurvivalCurve curve;
  curve.steps.push_back({0, at_risk, 0, 1, 0, wilson_interval(at_risk, at_risk)});
  double greenwood = 0;
  for (const auto& [at, leaving] : by_distance(lifetimes)) {
    curve.last_at = at;
    if (leaving.ended > 0) {
      const SurvivalStep& before = curve.steps.back();
      const double staying = at_risk - leaving.ended;
      SurvivalStep step{at, at_risk, leaving.ended, before.share * staying / at_risk, 0, {}};
      if (staying > 0) {
        greenwood += leaving.ended / (at_risk * staying);
        step.standard_error = step.share * std::sqrt(greenwood);
        step.interval = log_log_interval(step.share, greenwood);
      } else {
        step.interval = {0, before.interval.maximum};
      }
      curve.steps.push_back(step);
    }
    at_risk -= leaving.ended + leaving.censored;
  }
  return curve;
}

const SurvivalStep& survival_at(const SurvivalCurve& curve, double at) {
  const auto after = std::ranges::upper_bound(curve.steps, at, {}, &SurvivalStep::at);
  return after == curve.steps.begin() ? curve.steps.front() : *std::prev(after);
}

std::optional<double> median_survival(const SurvivalCurve& curve) {
  // Shares are products of fractions: half may come out a few units of the last place above 0.5.
  for (const SurvivalStep& step : curve.steps)
    if (step.share <= 0.5 + 1e-12) return step.at;
  return {};
}

LogRank log_rank(const std::vector<Lifetime>& first, const std::vector<Lifetime>& second) {
  std::vector<Lifetime> all = first;
  all.insert(all.end(), second.begin(), second.end());
  const auto ended = [](const std::vector<Lifetime>& group) {
    return static_cast<double>(std::ranges::count_if(group, &Lifetime::ended));
  };
  LogRank test;
  double variance = 0;
  for (const auto& [at, leaving] : by_distance(all)) {
    const double n = count_at_risk(all, at), d = leaving.ended;
    const double share = count_at_risk(first, at) / n;
    test.expected_first += d * share;
    if (n > 1) variance += d * share * (1 - share) * (n - d) / (n - 1);
  }
  test.expected_second = ended(all) - test.expected_first;
  if (variance == 0) return test;
  const double more = ended(first) - test.expected_first;
  test.chi_square = more * more / variance;
  test.p = boost::math::cdf(complement(boost::math::chi_squared_distribution<double>(1), test.chi_square));
  return test;
}

}  // namespace understory
