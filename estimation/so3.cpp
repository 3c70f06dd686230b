#include "estimation/so3.hpp"

#include <cmath>

namespace understory::so3 {
namespace {

/// Below this angle the next term of the series is smaller than the rounding of a double.
constexpr double small_angle_rad = 1e-4;

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d matrix;
  matrix << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return matrix;
}

Eigen::Matrix3d exp(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  const double squared = angle * angle;
  const bool small = angle < small_angle_rad;
  const double first = small ? 1 - squared / 6 : std::sin(angle) / angle;
  const double second = small ? 0.5 - squared / 24 : (1 - std::cos(angle)) / squared;
  const Eigen::Matrix3d cross = skew(rotation_vector);
  return Eigen::Matrix3d::Identity() + first * cross + second * cross * cross;
}

Eigen::Vector3d log(const Eigen::Matrix3d& rotation) {
  // By way of the quaternion, which is well conditioned at pi. The trace formula is not.
  Eigen::Quaterniond quaternion(rotation);
  if (quaternion.w() < 0) quaternion.coeffs() = -quaternion.coeffs();
  const double sine = quaternion.vec().norm();
  if (sine < small_angle_rad) return 2 * (1 + sine * sine / 6) * quaternion.vec();
  return 2 * std::atan2(sine, quaternion.w()) / sine * quaternion.vec();
}

Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  const double squared = angle * angle;
  const bool small = angle < small_angle_rad;
  const double first = small ? 0.5 - squared / 24 : (1 - std::cos(angle)) / squared;
  const double second = small ? 1.0 / 6 - squared / 120 : (angle - std::sin(angle)) / (squared * angle);
  const Eigen::Matrix3d cross = skew(rotation_vector);
  return Eigen::Matrix3d::Identity() - first * cross + second * cross * cross;
}

}  // namespace understory::so3
