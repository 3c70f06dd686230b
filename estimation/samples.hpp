#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <variant>

/// What the sensors deliver. Body frame: x forward, y left, z up. World: x east, y north, z up. Times are the
/// moment of measurement. SI units.
namespace understory {

inline std::int64_t nanoseconds(double seconds) { return std::llround(seconds * 1e9); }
inline double seconds(std::int64_t t_ns) { return static_cast<double>(t_ns) * 1e-9; }

struct ImuSample {
  std::int64_t t_ns = 0;
  Eigen::Vector3d angular_rate_body_radps = Eigen::Vector3d::Zero();
  /// Acceleration minus gravity, as an accelerometer measures it: (0, 0, +9.81) at rest and level.
  Eigen::Vector3d specific_force_body_mps2 = Eigen::Vector3d::Zero();
};

struct PitotSample {
  std::int64_t t_ns = 0;
  double airspeed_mps = 0;  ///< along body x, from dynamic pressure; poor well below flight speed
};

struct BarometerSample {
  std::int64_t t_ns = 0;
  double altitude_m = 0;  ///< above the launch point's ground, z of the world frame
};

struct MagnetometerSample {
  std::int64_t t_ns = 0;
  Eigen::Vector3d field_body_ut =
      Eigen::Vector3d::Zero();  ///< microtesla; declination taken as zero (north = world y)
};

/// A GPS fix. It arrives late; t_ns is the moment of measurement.
struct GpsSample {
  std::int64_t t_ns = 0;
  Eigen::Vector3d position_world_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();
};

/// The thrust that the autopilot commands from t_ns on.
struct ThrustSample {
  std::int64_t t_ns = 0;
  double thrust_n = 0;
};

/// An obstacle seen at one depth and, later, at a nearer one: how far its place in the odometry frame has
/// moved in between, horizontally. The aircraft's estimate has drifted by the opposite.
struct ResightingSample {
  std::int64_t t_ns = 0;                                          ///< of the second sighting
  std::int64_t earlier_ns = 0;                                    ///< of the first
  Eigen::Vector2d discrepancy_world_m = Eigen::Vector2d::Zero();  ///< second place less first
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Identity();    ///< of the errors of vision
};

/// A sample of any kind.
using Sample = std::variant<ImuSample, PitotSample, BarometerSample, MagnetometerSample, GpsSample,
                            ResightingSample, ThrustSample>;

}  // namespace understory
