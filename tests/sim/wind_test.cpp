#include "sim/aircraft/wind.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "sim/scene/world.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;
constexpr double step_s = 1.0 / 1200;

/// Flies level and straight along world x through `wind`, at `airspeed_mps` relative to the mean wind.
struct Passage {
  Wind wind;
  Vector3d mean_world_mps;
  double altitude_m;
  double airspeed_mps = 12;
  std::int64_t step = 0;

  Vector3d next() {
    ++step;
    const Vector3d position(0, 0, altitude_m);
    wind.advance(time_of_step_ns(step), step_s, position, mean_world_mps + Vector3d(airspeed_mps, 0, 0));
    return wind.at(position);
  }
};

TEST(Wind, SteadyByDefaultToTheBit) {
  const Vector3d mean(1.25, -2.5, 0.3);
  Passage passage{Wind(mean, {}, {}, 5), mean, 2};
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(passage.next(), mean);
}

// The profile's own properties: the mean at the reference height, a slope of u / (h ln(h_ref / z_0)), zero
// where it is said to end.
TEST(Wind, ShearIsLogarithmic) {
  WindConfig config;
  config.roughness_m = 0.0457;
  const Vector3d mean(0, 3, 0);
  const Wind wind(mean, config, {}, 0);
  EXPECT_LT((wind.at({0, 0, 6.096}) - mean).norm(), 1e-12);
  EXPECT_NEAR(wind.at({0, 0, 3.048}).y(), 3 * (1 - std::log(2.0) / std::log(6.096 / 0.0457)), 1e-12);
  EXPECT_NEAR(wind.at({0, 0, 12.192}).y() - 3, 3 - wind.at({0, 0, 3.048}).y(), 1e-12);  // even in ln h
  EXPECT_EQ(wind.at({0, 0, 0}), wind.at({0, 0, 0.9}));  // below 3 ft as at 3 ft
  config.roughness_m = 2;
  EXPECT_EQ(Wind(mean, config, {}, 0).at({0, 0, 1}), Vector3d::Zero());
}

// MIL-F-8785C: half of it at half the length, all of it from the length on; the maximum slope is pi / 2
// amplitude / length at the middle.
TEST(Wind, GustIsOneMinusCosineOfTheWayFlown) {
  WindConfig config;
  config.gust = {2, 6, {0, 1, -4}};
  const Vector3d mean(0, 3, 0);
  Passage passage{Wind(mean, config, {}, 0), mean, 3};
  Vector3d before = mean;
  while (passage.step < 2 * 1200) ASSERT_EQ(before = passage.next(), mean);
  double steepest = 0;
  for (int i = 1; i <= 600; ++i) {  // 10 mm a step: 6 m in 600 steps
    const Vector3d now = passage.next();
    const double x_m = 12 * step_s * i;
    ASSERT_LT((now - mean - 0.5 * (1 - std::cos(std::numbers::pi * x_m / 6)) * Vector3d(0, 1, -4)).norm(),
              1e-9);
    steepest = std::max(steepest, (now - before).norm() / (12 * step_s));
    before = now;
  }
  EXPECT_NEAR(steepest, std::numbers::pi / 2 * std::sqrt(17.0) / 6, 1e-4);
  EXPECT_LT((before - mean - Vector3d(0, 1, -4)).norm(), 1e-9);
  EXPECT_LT((passage.next() - mean - Vector3d(0, 1, -4)).norm(), 1e-9);  // and stays
}

TEST(Wind, ForestSheltersBelowItsCrowns) {
  WindConfig config;
  config.shelter_factor = 0.2;
  config.shelter_edge_m = 10;
  const Vector3d mean(0, 5, 0);
  const Wind wind(mean, config, {15, 75, 25, 9}, 0);
  EXPECT_EQ(wind.at({10, 0, 3}), mean);                         // before the forest
  EXPECT_LT((wind.at({45, 0, 3}) - 0.2 * mean).norm(), 1e-12);  // deep in it
  EXPECT_EQ(wind.at({45, 0, 9.5}), mean);                       // above it
  EXPECT_EQ(wind.at({45, 30, 3}), mean);                        // beside it
  EXPECT_LT((wind.at({20, 0, 3}) - 0.6 * mean).norm(), 1e-12);  // half way through the edge
  EXPECT_LT((wind.at({72.5, 0, 3}) - 0.8 * mean).norm(), 1e-12);
}

// The world's components are the Dryden components turned by the mean wind's direction: along 1.93 sigma_w
// (20 ft), across as much, up sigma_w = 0.1 W20, at the flight's own 1200 Hz. Sigma of a mean square over a
// way s is sqrt(2 L / s): 6000 s of 12 m/s are 72 km, so 3.5 % along, 1.3 % up.
TEST(Wind, TurbulenceHasItsVarianceInTheMeanWindsAxes) {
  WindConfig config;
  config.turbulence_wind20_mps = 3;
  const Vector3d mean(-2, 2, 0);
  Passage passage{Wind(mean, config, {}, 9), mean, 6.096};
  const Vector3d along = mean.normalized(), up = Vector3d::UnitZ(), across = up.cross(along);
  Vector3d squares = Vector3d::Zero();
  double both = 0;
  constexpr int count = 6000 * 1200;
  for (int i = 0; i < count; ++i) {
    const Vector3d gust = passage.next() - mean;
    const Vector3d parts(gust.dot(along), gust.dot(across), gust.dot(up));
    squares += parts.cwiseAbs2();
    both += parts.x() * parts.y();
  }
  const DrydenScales scales = low_altitude_dryden(6.096, 3);
  EXPECT_NEAR(squares.x() / count / std::pow(scales.sigma_mps.x(), 2), 1, 0.14);
  EXPECT_NEAR(squares.y() / count / std::pow(scales.sigma_mps.y(), 2), 1, 0.14);
  EXPECT_NEAR(squares.z() / count / std::pow(scales.sigma_mps.z(), 2), 1, 0.05);
  EXPECT_NEAR(both / count / std::pow(scales.sigma_mps.x(), 2), 0, 0.14);
}

TEST(Wind, SameSeedSameAir) {
  WindConfig config;
  config.turbulence_wind20_mps = 3;
  const auto air = [&](std::uint64_t seed) {
    Passage passage{Wind(Vector3d(0, 3, 0), config, {}, seed), {0, 3, 0}, 4};
    Vector3d last;
    for (int i = 0; i < 1200; ++i) last = passage.next();
    return last;
  };
  EXPECT_EQ(air(1), air(1));
  EXPECT_NE(air(1), air(2));
}

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
