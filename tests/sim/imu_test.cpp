#include "sim/sensors/sensors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "sim/sensors/sensors_config.hpp"
#include "tests/sim/sensor_statistics.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

TEST(Imu, NoiseWithinAFlightIsTheDataSheets) {
  const ImuConfig config;
  Imu imu(config, 5);
  const Statistics rate =
      statistics(20000, [&](int) { return imu.measure(cruising()).angular_rate_body_radps.x(); });
  Imu other(config, 6);
  const Statistics force =
      statistics(20000, [&](int) { return other.measure(cruising()).specific_force_body_mps2.z(); });
  EXPECT_NEAR(rate.deviation, 0.14 * 3.14159265 / 180, 0.0002);
  EXPECT_NEAR(rate.mean, 0.1, 4 * config.gyro_bias_radps);
  EXPECT_NEAR(force.deviation, 0.05, 0.002);
  EXPECT_NEAR(force.mean, 9.81, 4 * config.accelerometer_bias_mps2);
}

TEST(Imu, BiasIsConstantInAFlightAndDrawnForEach) {
  ImuConfig config;
  config.gyro_noise_radps = config.gyro_step_radps = 0;
  Imu imu(config, 1);
  const Vector3d first = imu.measure(cruising()).angular_rate_body_radps;
  EXPECT_EQ(imu.measure(cruising()).angular_rate_body_radps, first);
  EXPECT_TRUE((first - cruising().angular_rate_body_radps).isApprox(imu.gyro_bias_radps(), 1e-12));
  const Statistics bias = statistics(4000, [&](int flight) {
    return Imu(config, static_cast<std::uint64_t>(flight)).gyro_bias_radps().y();
  });
  EXPECT_NEAR(bias.mean, 0, 4 * config.gyro_bias_radps / std::sqrt(4000.0));
  EXPECT_NEAR(bias.deviation, config.gyro_bias_radps, 0.05 * config.gyro_bias_radps);
}

TEST(Imu, SaturatesAndQuantises) {
  const ImuConfig config;
  Imu imu(config, 1);
  Truth truth = cruising();
  truth.angular_rate_body_radps = Vector3d(100, 0, -100);
  truth.specific_force_body_mps2 = Vector3d(500, 0, 0);
  const ImuSample sample = imu.measure(truth);
  EXPECT_NEAR(sample.angular_rate_body_radps.x(), config.gyro_range_radps, config.gyro_step_radps);
  EXPECT_NEAR(sample.angular_rate_body_radps.z(), -config.gyro_range_radps, config.gyro_step_radps);
  EXPECT_NEAR(sample.specific_force_body_mps2.x(), config.accelerometer_range_mps2,
              config.accelerometer_step_mps2);
  const double counts = imu.measure(cruising()).angular_rate_body_radps.y() / config.gyro_step_radps;
  EXPECT_NEAR(counts, std::round(counts), 1e-6);
}

TEST(Imu, CatapultStaysInRange) {
  Truth truth = cruising();
  truth.specific_force_body_mps2 = Vector3d(60, 0, 10);
  EXPECT_NEAR(Imu(ImuConfig{}, 1).measure(truth).specific_force_body_mps2.x(), 60, 0.5);
}

/// No errors, whatever is then switched on.
ImuConfig exact() { return sensors_of_grade(SensorGrade::ideal).imu; }

Truth turning_about(int axis) {
  Truth truth;
  truth.angular_rate_body_radps = Vector3d::Unit(axis);
  truth.specific_force_body_mps2 = Vector3d::Unit(axis);
  return truth;
}

TEST(Imu, WithoutErrorsReadsTheTruth) {
  const ImuSample sample = Imu(exact(), 1).measure(cruising());
  EXPECT_EQ(sample.angular_rate_body_radps, cruising().angular_rate_body_radps);
  EXPECT_EQ(sample.specific_force_body_mps2, cruising().specific_force_body_mps2);
}

TEST(Imu, ScaleAndMisalignmentAreDrawnForEachFlight) {
  ImuConfig config = exact();
  config.gyro_scale = 0.01;
  config.gyro_misalignment = 0.005;
  config.accelerometer_scale = 0.02;
  config.accelerometer_misalignment = 0.004;
  const auto gain = [&](int flight, int from) {
    return Imu(config, static_cast<std::uint64_t>(flight)).measure(turning_about(from));
  };
  const auto of_rate = [&](int from, int to) {
    return statistics(4000, [&](int flight) { return gain(flight, from).angular_rate_body_radps[to]; });
  };
  const auto of_force = [&](int from, int to) {
    return statistics(4000, [&](int flight) { return gain(flight, from).specific_force_body_mps2[to]; });
  };
  EXPECT_NEAR(of_rate(0, 0).mean, 1, 0.001);
  EXPECT_NEAR(of_rate(0, 0).deviation, 0.01, 0.0005);
  EXPECT_NEAR(of_rate(0, 2).mean, 0, 0.0005);
  EXPECT_NEAR(of_rate(0, 2).deviation, 0.005, 0.00025);
  EXPECT_NEAR(of_force(2, 2).deviation, 0.02, 0.001);
  EXPECT_NEAR(of_force(2, 1).deviation, 0.004, 0.0002);
  // One and the same all flight.
  Imu imu(config, 1);
  EXPECT_EQ(imu.measure(turning_about(1)).angular_rate_body_radps,
            imu.measure(turning_about(1)).angular_rate_body_radps);
}

TEST(Imu, ThePropellerShakesItAcrossItsShaft) {
  ImuConfig config = exact();
  config.accelerometer_vibration_mps2pn = 0.8;
  config.gyro_vibration_radpspn = 0.02;
  config.propeller_hz_at_1n = 70;
  Imu imu(config, 1);
  Truth truth;
  truth.thrust_n = 2.25;  // 70 Hz * sqrt(2.25) = 105 turns a second
  double squares = 0, rate_squares = 0, before = 0;
  int rises = 0;
  for (int step = 0; step < 1200; ++step) {
    truth.t_ns = time_of_step_ns(step);
    const ImuSample sample = imu.measure(truth);
    EXPECT_EQ(sample.specific_force_body_mps2.x(), 0);
    EXPECT_NEAR(sample.specific_force_body_mps2.norm(), 0.8 * 2.25, 1e-9);
    const double now = sample.specific_force_body_mps2.y();
    rises += before < 0 && now >= 0;
    before = now;
    squares += now * now / 1200;
    rate_squares += sample.angular_rate_body_radps.squaredNorm() / 1200;
  }
  EXPECT_NEAR(std::sqrt(squares), 0.8 * 2.25 / std::sqrt(2.0), 0.01);
  EXPECT_NEAR(std::sqrt(rate_squares), 0.02 * 2.25, 1e-9);
  EXPECT_NEAR(rises, 105, 1);
  truth.thrust_n = 0;
  EXPECT_EQ(imu.measure(truth).specific_force_body_mps2, Vector3d::Zero());
}

TEST(Imu, AnEffectMovesNoOtherDraw) {
  ImuConfig with_effects;
  with_effects.gyro_scale = with_effects.gyro_misalignment = 0.1;
  with_effects.accelerometer_scale = 0.1;
  with_effects.gyro_vibration_radpspn = 1;
  Imu plain(ImuConfig{}, 3), affected(with_effects, 3);
  for (int step = 0; step < 20; ++step) {
    Truth still;  // no rate to scale, no thrust to shake
    still.t_ns = time_of_step_ns(6 * step);
    const ImuSample sample = plain.measure(still), other = affected.measure(still);
    EXPECT_EQ(sample.angular_rate_body_radps, other.angular_rate_body_radps);
    EXPECT_EQ(sample.specific_force_body_mps2, other.specific_force_body_mps2);
  }
}

}  // namespace
}  // namespace understory
