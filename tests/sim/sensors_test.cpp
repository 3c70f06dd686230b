#include "sim/sensors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "sim/world.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

/// Level and steady along world x.
Truth cruising(double speed_mps = 12, std::int64_t step = 0) {
  Truth truth;
  truth.t_ns = time_of_step_ns(step);
  truth.T_world_body.translation() = Vector3d(0, 0, 3);
  truth.velocity_world_mps = Vector3d(speed_mps, 0, 0);
  truth.angular_rate_body_radps = Vector3d(0.1, -0.2, 0.3);
  truth.specific_force_body_mps2 = Vector3d(0, 0, 9.81);
  return truth;
}

struct Statistics {
  double mean = 0;
  double deviation = 0;
};

template <typename Draw>
Statistics statistics(int count, Draw draw) {
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const double value = draw(i);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean)};
}

TEST(Sensors, RatesMustFallOnPhysicsSteps) {
  for (const int good : {1, 40, 50, 120, 200, 1200}) EXPECT_TRUE(divides_physics_rate(good)) << good;
  for (const int bad : {-200, 0, 7, 140, 2400}) EXPECT_FALSE(divides_physics_rate(bad)) << bad;
}

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

TEST(Pitot, GoodInCruisePoorWhenSlow) {
  const double density = 1.204;
  Pitot pitot(PitotConfig{}, density, 3);
  const auto spread = [&](double speed) {
    return statistics(5000, [&](int) { return pitot.measure(cruising(speed)).airspeed_mps; });
  };
  const Statistics fast = spread(12);
  EXPECT_NEAR(fast.mean, 12, 0.3);
  EXPECT_NEAR(fast.deviation, 1.5 / (density * 12), 0.02);  // dv = dp / (rho v)
  EXPECT_GT(spread(3).deviation, 0.3);                      // a tenth of the reading
  const Statistics at_rest = statistics(2000, [&](int flight) {
    return Pitot(PitotConfig{}, density, static_cast<std::uint64_t>(flight))
        .measure(cruising(0))
        .airspeed_mps;
  });
  EXPECT_GT(at_rest.mean, 0.5);  // reads a wind that is not there
}

TEST(Pitot, MeasuresAlongTheBodyAndAgainstTheWind) {
  PitotConfig exact;
  exact.pressure_noise_pa = exact.pressure_bias_pa = exact.pressure_step_pa = 0;
  Pitot pitot(exact, 1.204, 3);
  Truth truth = cruising(12);
  truth.wind_world_mps = Vector3d(-3, 0, 0);
  EXPECT_NEAR(pitot.measure(truth).airspeed_mps, 15, 1e-9);
  truth.wind_world_mps.setZero();
  truth.T_world_body.linear() = Eigen::AngleAxisd(-0.2, Vector3d::UnitY()).toRotationMatrix();
  EXPECT_NEAR(pitot.measure(truth).airspeed_mps, 12 * std::cos(0.2), 1e-9);
  EXPECT_EQ(pitot.measure(cruising(-5)).airspeed_mps, 0);
  exact.bias_mps = 3;
  EXPECT_NEAR(Pitot(exact, 1.204, 3).measure(cruising(12)).airspeed_mps, 15, 1e-9);
}

TEST(Barometer, NoiseIsWhiteAndDriftIsSlow) {
  Barometer barometer(BarometerConfig{}, 9);
  const Statistics first_minute_seconds =
      statistics(250, [&](int i) { return barometer.measure(cruising(12, 24 * i)).altitude_m; });
  EXPECT_NEAR(first_minute_seconds.deviation, 0.3, 0.1);
  EXPECT_NEAR(first_minute_seconds.mean, 3, 0.5);

  BarometerConfig drifting;
  drifting.noise_m = drifting.step_m = 0;
  const Statistics far = statistics(3000, [&](int flight) {
    Barometer fresh(drifting, static_cast<std::uint64_t>(flight));
    fresh.measure(cruising(12, 0));
    return fresh.measure(cruising(12, 1200 * 600)).altitude_m;  // ten time constants later
  });
  EXPECT_NEAR(far.deviation, drifting.drift_m, 0.05);
  Barometer fresh(drifting, 1);
  fresh.measure(cruising(12, 0));
  EXPECT_NEAR(fresh.measure(cruising(12, 24)).altitude_m, 3, 0.1);  // 20 ms later: next to nothing
}

TEST(Magnetometer, FieldPointsNorthAndDown) {
  MagnetometerConfig exact;
  exact.noise_ut = exact.hard_iron_ut = exact.step_ut = 0;
  Magnetometer magnetometer(exact, 1);
  Truth truth = cruising();
  const Vector3d level = magnetometer.measure(truth).field_body_ut;
  EXPECT_NEAR(level.norm(), 48, 1e-9);
  EXPECT_NEAR(level.x(), 0, 1e-9);
  EXPECT_NEAR(level.y(), 48 * std::cos(67 * 3.14159265 / 180), 1e-3);  // flying east: north is to the left
  EXPECT_LT(level.z(), -40);
  truth.T_world_body.linear() = Eigen::AngleAxisd(3.14159265 / 2, Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_NEAR(magnetometer.measure(truth).field_body_ut.x(), level.y(), 1e-6);  // flying north
}

TEST(Magnetometer, NoiseAndHardIron) {
  Magnetometer magnetometer(MagnetometerConfig{}, 2);
  const Statistics field =
      statistics(10000, [&](int) { return magnetometer.measure(cruising()).field_body_ut.x(); });
  EXPECT_NEAR(field.deviation, 0.5, 0.02);
  const Statistics iron = statistics(2000, [](int flight) {
    MagnetometerConfig quiet;
    quiet.noise_ut = quiet.step_ut = 0;
    return Magnetometer(quiet, static_cast<std::uint64_t>(flight)).measure(cruising()).field_body_ut.x();
  });
  EXPECT_NEAR(iron.deviation, 0.5, 0.05);
}

TEST(Sensors, SameSeedSameSamplesOtherSeedOthers) {
  const auto samples = [](std::uint64_t seed) {
    Imu imu({}, seed);
    Pitot pitot({}, 1.204, seed);
    Barometer barometer({}, seed);
    Magnetometer magnetometer({}, seed);
    std::vector<double> all;
    for (int i = 0; i < 50; ++i) {
      const Truth truth = cruising(12, 24 * i);
      all.push_back(imu.measure(truth).specific_force_body_mps2.x());
      all.push_back(pitot.measure(truth).airspeed_mps);
      all.push_back(barometer.measure(truth).altitude_m);
      all.push_back(magnetometer.measure(truth).field_body_ut.z());
    }
    return all;
  };
  EXPECT_EQ(samples(1), samples(1));
  EXPECT_NE(samples(1), samples(2));
}

TEST(Sensors, SamplesCarryTheTruthsMoment) {
  const Truth truth = cruising(12, 123);
  EXPECT_EQ(Imu({}, 1).measure(truth).t_ns, time_of_step_ns(123));
  EXPECT_EQ(Pitot({}, 1.204, 1).measure(truth).t_ns, time_of_step_ns(123));
  EXPECT_EQ(Barometer({}, 1).measure(truth).t_ns, time_of_step_ns(123));
  EXPECT_EQ(Magnetometer({}, 1).measure(truth).t_ns, time_of_step_ns(123));
}

}  // namespace
}  // namespace understory
