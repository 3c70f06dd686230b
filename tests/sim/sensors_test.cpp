#include "sim/sensors/sensors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "sim/sensors/sensors_config.hpp"
#include "tests/sim/sensor_statistics.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;
const SensorsConfig ideal = sensors_of_grade(SensorGrade::ideal);

TEST(Sensors, SameSeedSameSamplesOtherSeedOthers) {
  const auto samples = [](std::uint64_t seed) {
    Imu imu({}, seed);
    Pitot pitot({}, 1.204, seed);
    Barometer barometer({}, seed);
    Magnetometer magnetometer({}, seed);
    Gps gps({}, seed);
    std::vector<double> all;
    for (int i = 0; i < 50; ++i) {
      const Truth truth = cruising(12, 24 * i);
      all.push_back(imu.measure(truth).specific_force_body_mps2.x());
      all.push_back(pitot.measure(truth).airspeed_mps);
      all.push_back(barometer.measure(truth).altitude_m);
      all.push_back(magnetometer.measure(truth).field_body_ut.z());
      all.push_back(gps.measure(truth).position_world_m.x());
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
  EXPECT_EQ(Gps({}, 1).measure(truth).t_ns, time_of_step_ns(123));
}

TEST(SensorGrades, PlainIsTheDefaultsAndGpsIsOffInAll) {
  const SensorsConfig plain = sensors_of_grade(SensorGrade::nominal);
  EXPECT_EQ(plain.imu.gyro_noise_radps, ImuConfig{}.gyro_noise_radps);
  for (const SensorGrade grade :
       {SensorGrade::ideal, SensorGrade::nominal, SensorGrade::consumer, SensorGrade::rough})
    EXPECT_FALSE(sensors_of_grade(grade).gps.enabled);
}

TEST(SensorGrades, IdealReadsTheTruth) {
  const Truth truth = cruising();
  const ImuSample inertial = Imu(ideal.imu, 1).measure(truth);
  EXPECT_EQ(inertial.angular_rate_body_radps, truth.angular_rate_body_radps);
  EXPECT_EQ(inertial.specific_force_body_mps2, truth.specific_force_body_mps2);
  EXPECT_NEAR(Pitot(ideal.pitot, 1.204, 1).measure(truth).airspeed_mps, 12, 1e-9);
  EXPECT_EQ(Barometer(ideal.barometer, 1).measure(truth).altitude_m, 3);
  EXPECT_NEAR(Magnetometer(ideal.magnetometer, 1).measure(truth).field_body_ut.norm(), 48, 1e-9);
  const GpsSample fix = Gps(ideal.gps, 1).measure(truth);
  EXPECT_EQ(fix.position_world_m, truth.T_world_body.translation());
  EXPECT_EQ(fix.velocity_world_mps, truth.velocity_world_mps);
}

TEST(SensorGrades, RoughIsThreeTimesConsumer) {
  const SensorsConfig consumer = sensors_of_grade(SensorGrade::consumer);
  const SensorsConfig rough = sensors_of_grade(SensorGrade::rough);
  EXPECT_DOUBLE_EQ(rough.imu.gyro_scale, 3 * consumer.imu.gyro_scale);
  EXPECT_DOUBLE_EQ(rough.imu.accelerometer_vibration_mps2pn, 3 * consumer.imu.accelerometer_vibration_mps2pn);
  EXPECT_DOUBLE_EQ(rough.pitot.recovery_loss, 3 * consumer.pitot.recovery_loss);
  EXPECT_DOUBLE_EQ(rough.barometer.noise_m, 3 * consumer.barometer.noise_m);
  EXPECT_DOUBLE_EQ(rough.magnetometer.soft_iron, 3 * consumer.magnetometer.soft_iron);
  EXPECT_EQ(rough.imu.gyro_range_radps, consumer.imu.gyro_range_radps);
  EXPECT_EQ(rough.gps.delay_s, consumer.gps.delay_s);
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

TEST(Barometer, ThePropellersWashReadsAsHeight) {
  BarometerConfig config = ideal.barometer;
  config.wash_m_per_n = 0.26;
  Barometer barometer(config, 1);
  Truth truth = cruising();
  EXPECT_EQ(barometer.measure(truth).altitude_m, 3);
  truth.thrust_n = 5;
  EXPECT_NEAR(barometer.measure(truth).altitude_m, 3 + 5 * 0.26, 1e-12);
}

constexpr std::int64_t steps_per_fix = 240;  // 5 Hz

TEST(Gps, VelocityNoiseIsWhite) {
  Gps gps(GpsConfig{}, 4);
  double previous = 0, product = 0;
  const Statistics error = statistics(20000, [&](int fix) {
    const double now = gps.measure(cruising(12, fix * steps_per_fix)).velocity_world_mps.x() - 12;
    product += now * previous / 20000;
    previous = now;
    return now;
  });
  EXPECT_NEAR(error.mean, 0, 0.006);
  EXPECT_NEAR(error.deviation, 0.2, 0.005);
  EXPECT_NEAR(product, 0, 0.002);
}

TEST(Gps, PositionErrorWandersFromTheFirstFixOn) {
  GpsConfig config;
  config.position_noise_m = 0;
  double squares = 0, product = 0, height_squares = 0;
  constexpr int flights = 4000;
  for (int flight = 0; flight < flights; ++flight) {
    Gps gps(config, static_cast<std::uint64_t>(flight));
    const Vector3d truth = cruising().T_world_body.translation();
    const Vector3d first = gps.measure(cruising()).position_world_m - truth;
    Vector3d later;
    for (int second = 1; second <= 60; ++second)  // one time constant
      later = gps.measure(cruising(12, 1200 * second)).position_world_m - truth;
    squares += first.x() * first.x() / flights;
    product += first.x() * later.x() / flights;
    height_squares += first.z() * first.z() / flights;
  }
  EXPECT_NEAR(std::sqrt(squares), 2.1, 0.1);
  EXPECT_NEAR(product / squares, std::exp(-1.0), 0.06);
  EXPECT_NEAR(std::sqrt(height_squares), 1.5 * 2.1, 0.15);
}

TEST(Gps, FixesAreNewByThePositionNoise) {
  GpsConfig config;
  config.position_drift_m = 0;
  Gps gps(config, 9);
  const Statistics error = statistics(
      5000, [&](int fix) { return gps.measure(cruising(12, fix * steps_per_fix)).position_world_m.y(); });
  EXPECT_NEAR(error.deviation, 0.3, 0.02);
}

TEST(Magnetometer, FieldPointsNorthAndDown) {
  Magnetometer magnetometer(ideal.magnetometer, 1);
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

TEST(Magnetometer, SoftIronBendsTheField) {
  MagnetometerConfig config = ideal.magnetometer;
  config.soft_iron = 0.02;
  const Vector3d true_ut = Magnetometer(ideal.magnetometer, 1).measure(cruising()).field_body_ut;
  // A row of independent entries times a field of 48 uT: 0.02 * 48 on every axis, across the field as along.
  for (int axis = 0; axis < 3; ++axis) {
    const Statistics bent = statistics(4000, [&](int flight) {
      return Magnetometer(config, static_cast<std::uint64_t>(flight)).measure(cruising()).field_body_ut[axis];
    });
    EXPECT_NEAR(bent.mean, true_ut[axis], 0.08) << axis;
    EXPECT_NEAR(bent.deviation, 0.02 * 48, 0.05) << axis;
  }
  // It turns with the body: the other way round, the other sign, as no hard iron would.
  Magnetometer magnetometer(config, 5);
  Truth truth = cruising();
  truth.T_world_body.linear().setIdentity();
  const Vector3d one_way = magnetometer.measure(truth).field_body_ut;
  truth.T_world_body.linear() = Eigen::AngleAxisd(M_PI, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_TRUE(magnetometer.measure(truth).field_body_ut.isApprox(-one_way, 1e-9));
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
  PitotConfig exact = ideal.pitot;
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

TEST(Pitot, LosesPressureOnlyBeyondTheRecoveryAngle) {
  PitotConfig config = ideal.pitot;
  config.recovery_angle_rad = 0.26;
  config.recovery_loss = 2;
  Pitot pitot(config, 1.204, 3);
  const auto turned_by = [&](double angle_rad, const Vector3d& about) {
    Truth truth = cruising(12);
    truth.T_world_body.linear() = Eigen::AngleAxisd(angle_rad, about).toRotationMatrix();
    return pitot.measure(truth).airspeed_mps;
  };
  EXPECT_NEAR(turned_by(0.25, Vector3d::UnitY()), 12 * std::cos(0.25), 1e-9);
  const double lossy = 12 * std::cos(0.46) * std::sqrt(1 - 2 * 0.2 * 0.2);
  EXPECT_NEAR(turned_by(-0.46, Vector3d::UnitY()), lossy, 1e-9);
  EXPECT_NEAR(turned_by(0.46, Vector3d::UnitZ()), lossy, 1e-9);  // sideslip as well
  EXPECT_EQ(turned_by(1.5, Vector3d::UnitY()), 0);
}

TEST(Pitot, SmallPressuresReadZeroInTheDeadZone) {
  PitotConfig config = ideal.pitot;
  config.dead_zone_pa = 4;  // 2.58 m/s
  Pitot pitot(config, 1.204, 3);
  EXPECT_EQ(pitot.measure(cruising(2.57)).airspeed_mps, 0);
  EXPECT_NEAR(pitot.measure(cruising(2.59)).airspeed_mps, 2.59, 1e-9);
}

}  // namespace
}  // namespace understory
