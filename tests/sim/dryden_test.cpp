#include "sim/aircraft/wind.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace understory {
namespace {

using Eigen::Vector3d;
constexpr double pi = std::numbers::pi;

// MIL-F-8785C, worked by hand at the two ends of the model's range and at W20's own height.
TEST(Dryden, ScalesAreTheMilitarySpecifications) {
  const DrydenScales top = low_altitude_dryden(304.8, 10);
  EXPECT_TRUE(
      top.length_m.isApprox(Vector3d::Constant(304.8), 1e-12));  // 1000 ft: the same in every direction
  EXPECT_TRUE(top.sigma_mps.isApprox(Vector3d::Constant(1.0), 1e-12));
  const DrydenScales twenty_feet = low_altitude_dryden(6.096, 10);
  EXPECT_NEAR(twenty_feet.length_m.x(), 43.76, 0.01);  // 20 ft / 0.19346^1.2 = 143.6 ft
  EXPECT_EQ(twenty_feet.length_m.y(), twenty_feet.length_m.x());
  EXPECT_NEAR(twenty_feet.length_m.z(), 6.096, 1e-12);
  EXPECT_NEAR(twenty_feet.sigma_mps.x(), 1.9291, 1e-4);  // 1 / 0.19346^0.4
  EXPECT_EQ(twenty_feet.sigma_mps.y(), twenty_feet.sigma_mps.x());
  EXPECT_DOUBLE_EQ(twenty_feet.sigma_mps.z(), 1.0);
  EXPECT_EQ(low_altitude_dryden(0.5, 3).length_m.z(), 3.048);  // the model ends at 10 ft
}

constexpr double step_m = 0.1;

/// `count` values of the three components, `step_m` apart.
std::array<std::vector<double>, 3> series(DrydenTurbulence& turbulence, const Vector3d& length_m, int count) {
  std::array<std::vector<double>, 3> values;
  for (int i = 0; i < count; ++i) {
    turbulence.advance(step_m, length_m);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      values[axis].push_back(turbulence.unit_gust()[static_cast<int>(axis)]);
    }
  }
  return values;
}

double closed_form(int axis, double length_m, double wavenumber) {
  const double square = std::pow(length_m * wavenumber, 2);
  return axis == 0 ? 2 * length_m / pi / (1 + square)
                   : length_m / pi * (1 + 3 * square) / std::pow(1 + square, 2);
}

/// Averaged periodogram under a Hann window, one-sided, per rad/m: segments of 2^15 values end to end.
class Periodogram {
 public:
  static constexpr int length = 1 << 15;
  static constexpr double bin = 2 * pi / (length * step_m);

  Periodogram() : sum_(length / 2, 0.0) {
    for (int i = 0; i < length; ++i) window_.push_back(0.5 - 0.5 * std::cos(2 * pi * i / length));
  }
  void add(std::vector<double> segment) {
    for (std::size_t i = 0; i < window_.size(); ++i) segment[i] *= window_[i];
    std::vector<std::complex<double>> spectrum;
    fft_.fwd(spectrum, segment);
    constexpr double window_power = 0.375;
    for (std::size_t i = 0; i < sum_.size(); ++i) {
      sum_[i] += std::norm(spectrum[i]) * step_m / (pi * window_power * length);
    }
    ++segments_;
  }
  /// Mean over bins [from, to).
  double density(int from, int to) const {
    double sum = 0;
    for (int i = from; i < to; ++i) sum += sum_[static_cast<std::size_t>(i)];
    return sum / (segments_ * (to - from));
  }

 private:
  Eigen::FFT<double> fft_;
  std::vector<double> window_, sum_;
  int segments_ = 0;
};

// 4.5 m above ground, where the forest is flown: 328 km of air in 100 segments. A periodogram's value has a
// relative sigma of 1; the mean of n bins and 100 segments one of sqrt(1.9 / (100 n)), 1.9 for what the Hann
// window makes neighbours share. Allowed are four of these and 2 % for leakage and aliasing, which at most
// make 1.6 % (bin 8, slope -2) and 0.9 % (a twentieth of the sampling).
TEST(Dryden, SpectraAreTheClosedForm) {
  constexpr int segments = 100;
  const Vector3d length_m = low_altitude_dryden(4.5, 1).length_m;
  DrydenTurbulence turbulence(7);
  std::array<Periodogram, 3> periodograms;
  Vector3d variance = Vector3d::Zero();
  for (int segment = 0; segment < segments; ++segment) {
    const auto values = series(turbulence, length_m, Periodogram::length);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const double value : values[axis]) variance[static_cast<int>(axis)] += value * value;
      periodograms[axis].add(values[axis]);
    }
  }
  variance /= segments * Periodogram::length;
  for (int axis = 0; axis < 3; ++axis) {
    for (int from = 8; from < Periodogram::length / 20; from = from * 3 / 2) {
      const int to = from * 3 / 2;
      double expected = 0;
      for (int i = from; i < to; ++i) expected += closed_form(axis, length_m[axis], i * Periodogram::bin);
      expected /= to - from;
      const double sigma = std::sqrt(1.9 / (segments * (to - from)));
      EXPECT_NEAR(periodograms[static_cast<std::size_t>(axis)].density(from, to) / expected, 1,
                  4 * sigma + 0.02)
          << "axis " << axis << ", " << from * Periodogram::bin << " rad/m";
    }
    // The variance of a mean square over a way s: 2 (integral of rho^2) / s = 2 L / s for either spectrum at
    // most.
    const double way_m = segments * Periodogram::length * step_m;
    EXPECT_NEAR(variance[axis], 1, 4 * std::sqrt(2 * length_m[axis] / way_m)) << "axis " << axis;
  }
}

// Fourier transforms of the two spectra: exp(-x / L) along, exp(-x / L) (1 - x / 2 L) across. Whatever the
// steps are, what lies x apart is correlated so.
TEST(Dryden, CorrelationIsTheSameForAnyStep) {
  const Vector3d length_m(10, 10, 4);
  for (const int parts : {1, 7}) {
    DrydenTurbulence turbulence(11);
    constexpr double apart_m = 3;
    constexpr int count = 100'000;
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < count; ++i) {
      const Vector3d before = turbulence.unit_gust();
      for (int part = 0; part < parts; ++part) turbulence.advance(apart_m / parts, length_m);
      sum += before.cwiseProduct(turbulence.unit_gust());
    }
    const double share = apart_m / length_m.x(), share_up = apart_m / length_m.z();
    // Sigma of the mean: about sqrt(2 L / way) = 0.8 % along, less across and up.
    EXPECT_NEAR(sum.x() / count, std::exp(-share), 0.03);
    EXPECT_NEAR(sum.y() / count, std::exp(-share) * (1 - share / 2), 0.03);
    EXPECT_NEAR(sum.z() / count, std::exp(-share_up) * (1 - share_up / 2), 0.03);
  }
}

TEST(Dryden, ComponentsAreIndependentAndBeginStationary) {
  constexpr int count = 20'000;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    const Vector3d gust = DrydenTurbulence(seed).unit_gust();
    sum += gust * gust.transpose();
  }
  EXPECT_LT((sum / count - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.04);  // four sigma
}

TEST(Dryden, StandingStillMeetsNothingNew) {
  DrydenTurbulence turbulence(3);
  const Vector3d before = turbulence.unit_gust();
  for (const double distance_m : {0.0, 0.0, 1e-12}) turbulence.advance(distance_m, {10, 10, 4});
  EXPECT_TRUE(turbulence.unit_gust().allFinite());
  EXPECT_LT((turbulence.unit_gust() - before).norm(), 1e-4);
}

}  // namespace
}  // namespace understory
