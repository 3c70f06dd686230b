#include "sim/sensors/sensors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/sensors/sensors_config.hpp"
#include "tests/sim/sensor_statistics.hpp"

/// The consumer grade's Allan deviation against docs/sensors.md.
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
  for (const int averaged_s : {4, 30, 200})
    EXPECT_NEAR(series.deviation(static_cast<std::size_t>(averaged_s) * 10), 0.5, 0.04) << averaged_s;
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
  for (std::int64_t second = 0; second < 10; ++second)
    EXPECT_EQ(wander.at(second * 1'000'000'000), Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace understory
