#include "scenarios/statistics/survival.hpp"

#include <cmath>
#include <map>

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

}  // namespace

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
