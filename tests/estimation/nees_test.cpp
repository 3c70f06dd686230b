#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "estimation/filter.hpp"
#include "simulated_flight.hpp"

namespace understory::test {
namespace {

/// White noise of exactly the modelled size, constant gyro biases from the modelled prior, nothing else.
struct Modelled {
  SensorErrors errors;
  FilterConfig config;
};

Modelled modelled() {
  Modelled set;
  set.errors = SensorErrors::none();
  set.errors.gyro_noise = 0.00244;
  set.errors.gyro_bias = 0.0087;
  set.errors.force_noise = 0.05;
  set.errors.pitot_noise = 0.1;
  set.errors.barometer_noise = 0.3;
  set.errors.field_noise = 0.5;
  FilterConfig& config = set.config;
  config.start.in_flight = true;
  config.states.accelerometer_bias = config.states.pitot_bias = false;
  config.gyro_noise_radps_rthz = set.errors.gyro_noise * std::sqrt(0.005);
  config.accelerometer_noise_mps2_rthz = set.errors.force_noise * std::sqrt(0.005);
  config.gyro_bias_walk_rthz = 0;
  config.altitude.offset_sigma_m = config.altitude.offset_walk_m_rts = 0;
  config.airspeed.sigma_mps = set.errors.pitot_noise;
  config.altitude.sigma_m = set.errors.barometer_noise;
  config.heading.sigma_rad = set.errors.field_noise / (48 * std::cos(67 * M_PI / 180));
  config.sideslip.sigma_mps2 = config.angle_of_attack.sigma_mps2 = set.errors.force_noise;
  config.sideslip.model_error = config.angle_of_attack.model_error = 0;
  config.distrust.gate_probability = 0.999999;
  config.start.horizontal_sigma_m = 0.5;
  config.start.vertical_sigma_m = 0.5;
  return set;
}

/// Starts the filter at the truth less an error drawn from its own prior.
FilterConfig displaced(const FilterConfig& config, const Moment& truth, std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  const auto draw = [&](double sigma) { return sigma * normal(generator); };
  FilterConfig displaced = config;
  StartConfig& start = displaced.start;
  start_at(start, truth);
  start.yaw_rad += draw(start.yaw_sigma_rad);
  start.pitch_rad += draw(start.tilt_sigma_rad);
  start.roll_rad += draw(start.tilt_sigma_rad);
  for (double& v : start.velocity_body_mps) v += draw(start.velocity_sigma_mps);
  for (double& p : start.position_world_m) p += draw(start.horizontal_sigma_m);
  return displaced;
}

struct Nees {
  double all = 0, attitude = 0, velocity = 0, position = 0, bias = 0;
};

Nees average_nees(const Modelled& set) {
  constexpr int seeds = 50;
  std::vector<Moment> flight = fly(dodge(), 3.2);
  flight.erase(flight.begin(), flight.begin() + 160);  // begin in steady flight, wings level
  Nees mean;
  for (int seed = 0; seed < seeds; ++seed) {
    std::mt19937_64 generator(500 + seed);
    Filter filter(displaced(set.config, flight.front(), generator));
    Sensors sensors(set.errors, 9000 + seed);
    for (const Moment& moment : flight) sensors.feed(filter, moment);
    const Vector12d error = error_of(filter.state(), flight.back(), sensors.gyro_bias);
    const Eigen::Matrix<double, 12, 12> covariance = filter.state().covariance.topLeftCorner<12, 12>();
    const auto block = [&](int first) {
      const Eigen::Vector3d part = error.segment<3>(first);
      const Eigen::Matrix3d spread = covariance.block<3, 3>(first, first);
      return part.dot(spread.inverse() * part) / seeds;
    };
    mean.all += error.dot(covariance.ldlt().solve(error)) / seeds;
    mean.attitude += block(attitude_block);
    mean.velocity += block(velocity_block);
    mean.position += block(position_block);
    mean.bias += block(rate_block);
  }
  return mean;
}

/// 99.8 % bounds of the mean of 50 chi-square variables: chi2(600)/50 (all states), chi2(150)/50 (one block).
constexpr double all_minimum = 9.97, all_maximum = 14.25, block_minimum = 2.02, block_maximum = 4.17;

void expect_block(double block, const char* name) {
  EXPECT_GT(block, block_minimum) << name;
  EXPECT_LT(block, block_maximum) << name;
}

void expect_chi_square(const Nees& nees) {
  EXPECT_GT(nees.all, all_minimum);
  EXPECT_LT(nees.all, all_maximum);
  expect_block(nees.attitude, "attitude");
  expect_block(nees.velocity, "velocity");
  expect_block(nees.position, "position");
  expect_block(nees.bias, "gyro bias");
}

TEST(Nees, OfAllTwelveStatesOverFiftySeedsIsChiSquare) {
  for (const bool smooth : {false, true}) {
    Modelled set = modelled();
    set.config.smooth_frame = smooth;
    set.config.sideslip.model = SideslipModel::off;
    set.config.angle_of_attack.enabled = false;
    expect_chi_square(average_nees(set));
  }
}

/// With sideslip and angle of attack the accelerometer's noise enters twice, as input and as measurement, and
/// the two partly cancel; the filter takes them as independent, so its velocity may be better than it says,
/// never worse.
TEST(Nees, WithTheForcesAsMeasurementsOnlyTheVelocityIsCautious) {
  for (const bool smooth : {false, true}) {
    Modelled set = modelled();
    set.config.smooth_frame = smooth;
    const Nees nees = average_nees(set);
    EXPECT_LT(nees.all, all_maximum);
    EXPECT_LT(nees.velocity, block_maximum);
    expect_block(nees.attitude, "attitude");
    expect_block(nees.position, "position");
    expect_block(nees.bias, "gyro bias");
  }
}

/// The same with biases of accelerometer and pitot, each a state.
TEST(Nees, WithBiasesAsStatesIsChiSquareToo) {
  Modelled set = modelled();
  set.errors.force_bias = 0.05;
  set.errors.pitot_bias = 0.1;
  set.config.states.accelerometer_bias = true;
  set.config.states.accelerometer_bias_sigma_mps2 = 0.05;
  set.config.states.accelerometer_bias_walk_rthz = 0;
  set.config.states.pitot_bias = true;
  set.config.states.pitot_bias_sigma_mps = 0.1;
  set.config.states.pitot_bias_walk_rthz = 0;
  set.config.sideslip.model = SideslipModel::off;
  set.config.angle_of_attack.enabled = false;
  expect_chi_square(average_nees(set));
}

/// Distance between an obstacle that was seen 10 m ahead and its place by the estimate, when it is passed:
/// 95th percentile over seeds of sensor noise, metres.
double drift_m(const Manoeuvre& manoeuvre, const FilterConfig& config, int seeds = 60) {
  const std::vector<Moment> flight = fly(manoeuvre, 3.2);
  std::vector<double> drifts;
  for (int seed = 0; seed < seeds; ++seed) {
    Filter filter(config);
    Sensors sensors({}, 1000 + seed);
    std::vector<State> estimates;
    for (const Moment& moment : flight) {
      sensors.feed(filter, moment);
      estimates.push_back(filter.state());
    }
    for (const double seen_s : {1.5, 1.7, 1.9, 2.1, 2.3}) {
      const auto seen = static_cast<std::size_t>(seen_s / 0.005);
      std::size_t passed = seen;
      double flown = 0;
      while (passed + 1 < flight.size() && flown < 10) flown += flight[++passed].velocity_body.norm() * 0.005;
      const Eigen::Isometry3d true_motion = flight[seen].T_world_body.inverse() * flight[passed].T_world_body;
      const Eigen::Isometry3d motion =
          estimates[seen].T_world_body.inverse() * estimates[passed].T_world_body;
      drifts.push_back((true_motion.translation() - motion.translation()).norm());
    }
  }
  std::sort(drifts.begin(), drifts.end());
  return drifts[drifts.size() * 95 / 100];
}

TEST(Drift, OverTenMetresStaysBelowTwentyCentimetres) {
  const double level = drift_m(straight(), {}), dodging = drift_m(dodge(), {});
  RecordProperty("straight_m", std::to_string(level));
  RecordProperty("dodging_m", std::to_string(dodging));
  EXPECT_LT(level, 0.20);
  EXPECT_LT(dodging, 0.20);
}

TEST(Drift, SideslipFromLateralForceBeatsNoSideslip) {
  FilterConfig none;
  none.sideslip.model = SideslipModel::zero;
  none.sideslip.zero_sigma_mps = 0.5;
  none.distrust.exclude = false;  // otherwise the fault is detected and the pitot ignored
  EXPECT_LT(2 * drift_m(dodge(), {}), drift_m(dodge(), none));
}

TEST(Drift, DefaultsBeatTheOriginalInDodges) {
  EXPECT_LT(2 * drift_m(dodge(), {}), drift_m(dodge(), original_filter()));
}

}  // namespace
}  // namespace understory::test
