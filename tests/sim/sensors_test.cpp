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
}

TEST(SensorGrades, PlainIsTheDefaultsAndGpsIsOffInAll) {
  const SensorsConfig plain = sensors_of_grade(SensorGrade::plain);
  EXPECT_EQ(plain.imu.gyro_noise_radps, ImuConfig{}.gyro_noise_radps);
  for (const SensorGrade grade :
       {SensorGrade::ideal, SensorGrade::plain, SensorGrade::consumer, SensorGrade::rough}) {
    EXPECT_FALSE(sensors_of_grade(grade).gps.enabled);
  }
}

TEST(SensorGrades, IdealReadsTheTruth) {
  const SensorsConfig ideal = sensors_of_grade(SensorGrade::ideal);
  const Truth truth = cruising();
  EXPECT_EQ(Imu(ideal.imu, 1).measure(truth).angular_rate_body_radps, truth.angular_rate_body_radps);
  EXPECT_NEAR(Pitot(ideal.pitot, 1.204, 1).measure(truth).airspeed_mps, 12, 1e-9);
  EXPECT_EQ(Barometer(ideal.barometer, 1).measure(truth).altitude_m, 3);
  EXPECT_NEAR(Magnetometer(ideal.magnetometer, 1).measure(truth).field_body_ut.norm(), 48, 1e-9);
  EXPECT_EQ(Gps(ideal.gps, 1).measure(truth).position_world_m, truth.T_world_body.translation());
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

}  // namespace
}  // namespace understory
