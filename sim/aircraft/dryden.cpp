#include "sim/aircraft/dryden.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understory {
namespace {

constexpr double foot_m = 0.3048;

}  // namespace

DrydenScales low_altitude_dryden(double altitude_m, double wind20_mps) {
  const double height_ft = std::clamp(altitude_m / foot_m, 10.0, 1000.0);
  const double level = 0.177 + 0.000823 * height_ft;
  const double horizontal_m = height_ft / std::pow(level, 1.2) * foot_m;
  const double vertical_mps = 0.1 * wind20_mps;
  const double horizontal_mps = vertical_mps / std::pow(level, 0.4);
  return {{horizontal_m, horizontal_m, height_ft * foot_m}, {horizontal_mps, horizontal_mps, vertical_mps}};
}

DrydenTurbulence::DrydenTurbulence(std::uint64_t seed) : generator_(seed) {
  along_ = draw();
  for (Cascade* state : {&across_, &up_}) {  // stationary covariance [1/2 1/4; 1/4 1/4]
    const double first = draw(), second = draw();
    state->first = std::sqrt(0.5) * first;
    state->second = 0.5 * (std::sqrt(0.5) * first + std::sqrt(0.5) * second);
  }
}

void DrydenTurbulence::advance(double distance_m, const Eigen::Vector3d& length_m) {
  const double kept = std::exp(-distance_m / length_m.x());
  along_ = kept * along_ + std::sqrt(1 - kept * kept) * draw();
  advance(across_, distance_m / length_m.y());
  advance(up_, distance_m / length_m.z());
}

/// d first = -first + n, d second = -second + first over a step d of lengths: the transition is exp(-d) [1 0;
/// d 1], the noise's covariance the integral of exp(-2s) [1 s; s s^2], here by its Cholesky factor. For steps
/// below 1e-4 lengths the last pivot is lost in rounding and is clamped to zero; it is then millions of times
/// smaller than the contribution of `first`.
void DrydenTurbulence::advance(Cascade& state, double lengths) {
  const double kept = std::exp(-lengths);
  const double kept_twice = kept * kept;
  const double q11 = (1 - kept_twice) / 2;
  const double q12 = (1 - kept_twice * (1 + 2 * lengths)) / 4;
  const double q22 = (1 - kept_twice * (1 + 2 * lengths + 2 * lengths * lengths)) / 4;
  const double one = draw(), other = draw();
  const double pivot = std::sqrt(q11);
  const double below = pivot > 0 ? q12 / pivot : 0;
  const double second = kept * (state.second + lengths * state.first);
  state.first = kept * state.first + pivot * one;
  state.second = second + below * one + std::sqrt(std::max(0.0, q22 - below * below)) * other;
}

/// (1 + sqrt(3) s) / (1 + s)^2 read off the cascade: s / (1 + s)^2 is first - second.
Eigen::Vector3d DrydenTurbulence::unit_gust() const {
  const auto shaped = [](const Cascade& state) {
    return state.second + std::numbers::sqrt3 * (state.first - state.second);
  };
  return {along_, shaped(across_), shaped(up_)};
}

}  // namespace understory
