#include <gtest/gtest.h>

#include <cmath>

#include "sim/sensors/sensors.hpp"
#include "sim/sensors/sensors_config.hpp"
#include "tests/sim/allan_deviation.hpp"

/// The consumer grade's Allan deviation against docs/sensors.md.
namespace understory {
namespace {

constexpr double degree_per_hour = M_PI / 180 / 3600;
constexpr double micro_g = 9.80665e-6;

/// docs/sensors.md: MPU-6000, from its data sheet's noise densities and Greenheck's floors by
/// sigma^2 = N^2/t + floor^2 + K^2 t/3 (IEEE Std 952-1997). Change both or neither.
struct Row {
  double averaged_s;
  double gyro_degph;
  double accelerometer_ug;
};
constexpr Row table[] = {{0.01, 180, 4000}, {0.1, 57.1, 1265}, {1, 18.6, 402},
                         {10, 7.32, 132},   {100, 4.95, 54.1}, {1000, 4.77, 41.3}};

struct AllanOfImu {
  AllanSeries gyro, accelerometer;
  double rate_hz;

  /// At rest and level.
  AllanOfImu(const ImuConfig& config, double samples_per_s, double hours) : rate_hz(samples_per_s) {
    Imu imu(config, 1000);
    Truth at_rest;
    at_rest.specific_force_body_mps2 = Eigen::Vector3d(0, 0, 9.81);
    const auto count = static_cast<std::int64_t>(hours * 3600 * rate_hz);
    for (std::int64_t i = 0; i < count; ++i) {
      at_rest.t_ns = std::llround(static_cast<double>(i) / rate_hz * 1e9);
      const ImuSample sample = imu.measure(at_rest);
      gyro.add(sample.angular_rate_body_radps);
      accelerometer.add(sample.specific_force_body_mps2);
    }
  }

  void expect_table(double from_s, double to_s) const {
    for (const Row& row : table) {
      if (row.averaged_s < from_s || row.averaged_s > to_s) continue;
      const auto samples = static_cast<std::size_t>(std::lround(row.averaged_s * rate_hz));
      const double gyro_degph = gyro.deviation(samples) / degree_per_hour;
      const double accelerometer_ug = accelerometer.deviation(samples) / micro_g;
      EXPECT_NEAR(gyro_degph / row.gyro_degph, 1, 0.1) << row.averaged_s << " s";
      EXPECT_NEAR(accelerometer_ug / row.accelerometer_ug, 1, 0.1) << row.averaged_s << " s";
    }
  }
};

TEST(ImuAllan, AnHourAtFlightRateMeetsTheTablesNearEnd) {
  AllanOfImu(sensors_of_grade(SensorGrade::consumer).imu, 200, 1).expect_table(0.01, 1);
}

TEST(ImuAllan, DaysMeetItsFarEnd) {
  // At 4 Hz, or it would take minutes: white noise of the same density, of which fewer samples a second each
  // hold less. The converter's steps, which this noise no longer covers, are the other test's matter.
  constexpr double rate_hz = 4;
  ImuConfig config = sensors_of_grade(SensorGrade::consumer).imu;
  config.gyro_noise_radps *= std::sqrt(rate_hz / 200);
  config.accelerometer_noise_mps2 *= std::sqrt(rate_hz / 200);
  config.gyro_step_radps = config.accelerometer_step_mps2 = 0;
  AllanOfImu(config, rate_hz, 150).expect_table(1, 1000);
}

TEST(BiasWander, FlickerIsFlatAtItsFloor) {
  BiasWander wander(0.5, 0, 7);
  AllanSeries series;
  for (std::int64_t tick = 0; tick < 1'000'000; ++tick) series.add(wander.at(tick * 100'000'000));  // 10 Hz
  for (const int averaged_s : {4, 30, 200}) {
    EXPECT_NEAR(series.deviation(static_cast<std::size_t>(averaged_s) * 10), 0.5, 0.04) << averaged_s;
  }
}

TEST(BiasWander, RandomWalkRisesWithTheRootOfTime) {
  BiasWander wander(0, 0.5, 7);
  AllanSeries series;
  for (std::int64_t tick = 0; tick < 500'000; ++tick) series.add(wander.at(tick * 100'000'000));  // 10 Hz
  for (const int averaged_s : {2, 20, 100}) {
    const double closed_form = 0.5 * std::sqrt(averaged_s / 3.0);
    EXPECT_NEAR(series.deviation(static_cast<std::size_t>(averaged_s) * 10) / closed_form, 1, 0.08)
        << averaged_s;
  }
}

TEST(BiasWander, IsSilentWhereOff) {
  BiasWander wander(0, 0, 7);
  for (std::int64_t second = 0; second < 10; ++second) {
    EXPECT_EQ(wander.at(second * 1'000'000'000), Eigen::Vector3d::Zero());
  }
}

}  // namespace
}  // namespace understory
