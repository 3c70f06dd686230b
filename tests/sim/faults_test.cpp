#include "sim/sensors/faults.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace understory {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t second_ns = 1'000'000'000;

/// From 2 s on, for one.
FaultConfig fault(FaultySensor sensor, FaultKind kind, double value = 0) {
  return {sensor, kind, 2, 1, value};
}

/// What arrives of the readings 10, 11, ... m/s at 0.0, 0.5, ... s; -1 where nothing does.
std::vector<double> arrived(std::vector<FaultConfig> schedule, int count = 8) {
  Faults faults(std::move(schedule));
  std::vector<double> all;
  for (int i = 0; i < count; ++i) {
    PitotSample sample{i * second_ns / 2, 10.0 + i};
    all.push_back(faults.pass(sample) ? sample.airspeed_mps : -1);
    EXPECT_EQ(sample.t_ns, i * second_ns / 2);
  }
  return all;
}

using Readings = std::vector<double>;

TEST(Faults, NoneChangesNothing) { EXPECT_EQ(arrived({}), (Readings{10, 11, 12, 13, 14, 15, 16, 17})); }

TEST(Faults, EachKindActsFromItsMomentForItsDuration) {
  using enum FaultKind;
  constexpr FaultySensor pitot = FaultySensor::pitot;
  EXPECT_EQ(arrived({fault(pitot, freeze)}), (Readings{10, 11, 12, 13, 13, 13, 16, 17}));
  EXPECT_EQ(arrived({fault(pitot, dropout)}), (Readings{10, 11, 12, 13, -1, -1, 16, 17}));
  EXPECT_EQ(arrived({fault(pitot, bias, -2.5)}), (Readings{10, 11, 12, 13, 11.5, 12.5, 16, 17}));
  EXPECT_EQ(arrived({fault(pitot, saturate, 14.5)}), (Readings{10, 11, 12, 13, 14, 14.5, 16, 17}));
  EXPECT_EQ(arrived({fault(pitot, block, 0.5)}), (Readings{10, 11, 12, 13, 0.5, 0.5, 16, 17}));
}

TEST(Faults, AnotherSensorsFaultIsNone) {
  EXPECT_EQ(arrived({fault(FaultySensor::barometer, FaultKind::dropout)}), arrived({}));
}

TEST(Faults, SeveralActTogether) {
  using enum FaultKind;
  constexpr FaultySensor pitot = FaultySensor::pitot;
  EXPECT_EQ(arrived({{pitot, bias, 0, 10, 1}, fault(pitot, freeze), {pitot, dropout, 2.5, 0.1, 0}}),
            (Readings{11, 12, 13, 14, 14, -1, 17, 18}));
  EXPECT_EQ(arrived({{pitot, freeze, 0, 10, 0}}, 3), (Readings{10, 10, 10}));  // from the first reading on
}

ImuSample moving(std::int64_t t_ns) {
  const auto seconds = static_cast<double>(t_ns / second_ns);
  return {t_ns, Vector3d(1, -2, 3) * seconds, Vector3d(-4, 5, 6) * seconds};
}

TEST(Faults, GyroAndAccelerometerFailApart) {
  Faults faults({fault(FaultySensor::gyro, FaultKind::freeze),
                 fault(FaultySensor::accelerometer, FaultKind::saturate, 9)});
  ImuSample sample = moving(second_ns);
  ASSERT_TRUE(faults.pass(sample));
  EXPECT_EQ(sample.angular_rate_body_radps, moving(second_ns).angular_rate_body_radps);
  sample = moving(2 * second_ns);
  ASSERT_TRUE(faults.pass(sample));
  EXPECT_EQ(sample.angular_rate_body_radps, moving(second_ns).angular_rate_body_radps);
  EXPECT_EQ(sample.specific_force_body_mps2, Vector3d(-8, 9, 9));
  EXPECT_EQ(sample.t_ns, 2 * second_ns);
}

TEST(Faults, AnImuFailsAsAWhole) {
  Faults freezing({fault(FaultySensor::imu, FaultKind::freeze)});
  ImuSample sample = moving(second_ns);
  freezing.pass(sample);
  sample = moving(2 * second_ns);
  ASSERT_TRUE(freezing.pass(sample));
  EXPECT_EQ(sample.angular_rate_body_radps, moving(second_ns).angular_rate_body_radps);
  EXPECT_EQ(sample.specific_force_body_mps2, moving(second_ns).specific_force_body_mps2);
  for (const FaultySensor part : {FaultySensor::imu, FaultySensor::gyro, FaultySensor::accelerometer}) {
    sample = moving(2 * second_ns);
    EXPECT_FALSE(Faults({fault(part, FaultKind::dropout)}).pass(sample));
  }
  sample = moving(2 * second_ns);
  ASSERT_TRUE(Faults({fault(FaultySensor::gyro, FaultKind::bias, 0.5)}).pass(sample));
  EXPECT_EQ(sample.angular_rate_body_radps, Vector3d(2.5, -3.5, 6.5));
}

TEST(Faults, BarometerMagnetometerAndSatelliteFix) {
  Faults faults({fault(FaultySensor::barometer, FaultKind::bias, 3),
                 fault(FaultySensor::magnetometer, FaultKind::saturate, 20),
                 fault(FaultySensor::gps, FaultKind::bias, 10)});
  BarometerSample altitude{2 * second_ns, 4};
  ASSERT_TRUE(faults.pass(altitude));
  EXPECT_EQ(altitude.altitude_m, 7);
  MagnetometerSample field{2 * second_ns, Vector3d(0, 19, -44)};
  ASSERT_TRUE(faults.pass(field));
  EXPECT_EQ(field.field_body_ut, Vector3d(0, 19, -20));
  GpsSample fix{2 * second_ns, Vector3d(1, 2, 3), Vector3d(12, 0, 0)};
  ASSERT_TRUE(faults.pass(fix));
  EXPECT_EQ(fix.position_world_m, Vector3d(11, 12, 13));
  EXPECT_EQ(fix.velocity_world_mps, Vector3d(12, 0, 0));

  Faults freezing({fault(FaultySensor::gps, FaultKind::freeze)});
  fix = {second_ns, Vector3d(1, 2, 3), Vector3d(12, 0, 0)};
  freezing.pass(fix);
  fix = {2 * second_ns, Vector3d(13, 2, 3), Vector3d(11, 0, 0)};
  ASSERT_TRUE(freezing.pass(fix));
  EXPECT_EQ(fix.position_world_m.x(), 1);
  EXPECT_EQ(fix.velocity_world_mps.x(), 12);
  EXPECT_EQ(fix.t_ns, 2 * second_ns);
}

TEST(Faults, AFrozenCameraShowsItsLastPairAgain) {
  const auto pair = [](std::int64_t t_ns, int gray) {
    return StereoFrame{t_ns, cv::Mat(2, 3, CV_8UC1, cv::Scalar(gray)),
                       cv::Mat(2, 3, CV_8UC1, cv::Scalar(gray + 1))};
  };
  Faults freezing({fault(FaultySensor::camera, FaultKind::freeze)});
  StereoFrame frame = pair(second_ns, 50);
  freezing.pass(frame);
  frame = pair(2 * second_ns, 90);
  ASSERT_TRUE(freezing.pass(frame));
  EXPECT_EQ(frame.left.at<std::uint8_t>(1, 2), 50);
  EXPECT_EQ(frame.right.at<std::uint8_t>(0, 0), 51);
  EXPECT_EQ(frame.t_ns, 2 * second_ns);
  frame = pair(3 * second_ns, 90);
  ASSERT_TRUE(freezing.pass(frame));
  EXPECT_EQ(frame.left.at<std::uint8_t>(1, 2), 90);
  frame = pair(2 * second_ns, 90);
  EXPECT_FALSE(Faults({fault(FaultySensor::camera, FaultKind::dropout)}).pass(frame));
}

TEST(Faults, ASensorHasTheKindsThatMakeSense) {
  EXPECT_TRUE(can_have(FaultySensor::pitot, FaultKind::block));
  EXPECT_FALSE(can_have(FaultySensor::barometer, FaultKind::block));
  EXPECT_FALSE(can_have(FaultySensor::imu, FaultKind::bias));  // rad/s or m/s^2?
  EXPECT_FALSE(can_have(FaultySensor::gps, FaultKind::saturate));
  EXPECT_TRUE(can_have(FaultySensor::gyro, FaultKind::saturate));
  EXPECT_FALSE(can_have(FaultySensor::camera, FaultKind::bias));
}

}  // namespace
}  // namespace understory
