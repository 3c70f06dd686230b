#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "estimation/filter_config.hpp"
#include "estimation/samples.hpp"
#include "estimation/state_source.hpp"

/// A flight to test estimators with: rest and stroke on the catapult in closed form, then the flat-plate
/// wing's forces under given roll rates and angles of attack, integrated by RK4 at 1200 Hz. Written without
/// the filter's code.
namespace understory::test {

struct Moment {
  std::int64_t t_ns = 0;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_body = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_body = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_body = Eigen::Vector3d::Zero();  ///< specific force
};

/// Roll rate (rad/s) and target angle of attack (rad) over the time since release (s).
struct Manoeuvre {
  std::function<double(double)> roll_rate = [](double) { return 0.0; };
  std::function<double(double)> angle_of_attack = [](double) { return 0.191; };
  double start_s = 1.0;  ///< where drift is measured from
};

Manoeuvre straight();
/// Roll to 60 deg left, hold at load factor 2, across to 60 deg right, hold, level: about 2 s.
Manoeuvre dodge();

struct Launch {
  double rest_s = 0.25, speed_mps = 12.0, rail_m = 1.5, climb_rad = 0.20, altitude_m = 1.5;
};

/// Truth every 5 ms (the IMU's 200 Hz) for `flying_s` after release.
std::vector<Moment> fly(const Manoeuvre& manoeuvre, double flying_s, const Launch& launch = {});

struct SensorErrors {
  double gyro_noise = 0.00244, gyro_bias = 0.0087;     ///< rad/s per sample, per flight
  double force_noise = 0.05, force_bias = 0.05;        ///< m/s^2
  double pitot_noise = 0.1, pitot_bias = 0.07;         ///< m/s: 1.5 Pa and 1 Pa at 12 m/s
  double barometer_noise = 0.3, barometer_bias = 0.2;  ///< m
  double field_noise = 0.5, field_bias = 0.5;          ///< uT
  static SensorErrors none() { return {0, 0, 0, 0, 0, 0, 0, 0, 0, 0}; }
};

/// Turns truth into samples, with biases drawn once. IMU every moment, the others every fourth.
class Sensors {
 public:
  Sensors(const SensorErrors& errors, std::uint64_t seed);
  void feed(StateSource& to, const Moment& moment);
  double extra_pitot_mps = 0;
  Eigen::Vector3d gyro_bias, force_bias;

 private:
  double draw(double sigma);
  Eigen::Vector3d draw3(double sigma);
  SensorErrors errors_;
  std::mt19937_64 generator_;
  double pitot_bias_, barometer_bias_;
  Eigen::Vector3d field_bias_;
  int count_ = 0;
};

/// A start in flight that knows the truth's attitude, velocity and position.
void start_at(StartConfig& start, const Moment& truth);

using Vector12d = Eigen::Matrix<double, 12, 1>;

/// Error of the estimate in the filter's coordinates (attitude, velocity, position, gyro bias).
Vector12d error_of(const State& estimate, const Moment& truth, const Eigen::Vector3d& gyro_bias);

}  // namespace understory::test
