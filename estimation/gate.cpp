#include "estimation/gate.hpp"

#include <cmath>
#include <numbers>

#include "estimation/samples.hpp"

namespace understory {
namespace {

double chi_square_cumulative(double x, int degrees) {
  if (degrees == 2) return 1 - std::exp(-0.5 * x);
  const double one = std::erf(std::sqrt(0.5 * x));
  return degrees == 1 ? one : one - std::sqrt(2 * x / std::numbers::pi) * std::exp(-0.5 * x);
}

}  // namespace

double chi_square_quantile(double probability, int degrees) {
  double below = 0, above = 100;  // beyond 100 a double cannot tell the probability from 1
  for (int halving = 0; halving < 100; ++halving) {
    const double middle = 0.5 * (below + above);
    (chi_square_cumulative(middle, degrees) < probability ? below : above) = middle;
  }
  return 0.5 * (below + above);
}

Gate::Gate(double threshold, double patience_s, Distrust distrust)
    : threshold_(threshold), patience_ns_(nanoseconds(patience_s)), distrust_(distrust) {}

bool Gate::admits(double squared, std::int64_t t_ns) {
  newest_ = squared;
  const bool agrees = std::isfinite(squared) && squared <= threshold_;
  if (agrees != agrees_ || last_ns_ < 0) since_ns_ = t_ns;
  agrees_ = agrees;
  last_ns_ = t_ns;
  if (t_ns - since_ns_ > patience_ns_) faulty_ = !agrees;
  if (agrees && distrust_ == Distrust::believe) faulty_ = false;
  if (!std::isfinite(squared)) return false;
  return distrust_ == Distrust::exclude ? agrees && !faulty_ : agrees || faulty_;
}

}  // namespace understory
