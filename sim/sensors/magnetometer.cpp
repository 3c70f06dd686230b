#include "sim/sensors/magnetometer.hpp"

#include <cmath>

namespace understory {
namespace {

Eigen::Matrix3d bending(double sigma, std::uint64_t seed) {
  NoiseSource noise(seed);
  Eigen::Matrix3d drawn;
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) {
      drawn(row, column) = drawn(column, row) = noise.gaussian(sigma);
    }
  }
  return Eigen::Matrix3d::Identity() + drawn;
}

}  // namespace

Magnetometer::Magnetometer(const MagnetometerConfig& config, std::uint64_t seed)
    : config_(config),
      noise_(seed),
      hard_iron_body_ut_(noise_.gaussian_vector(config.hard_iron_ut)),
      soft_iron_(bending(config.soft_iron, effect_seed(seed, 1))) {}

MagnetometerSample Magnetometer::measure(const Truth& truth) {
  const Eigen::Vector3d field_world_ut =
      config_.field_ut *
      Eigen::Vector3d(0, std::cos(config_.inclination_rad), -std::sin(config_.inclination_rad));
  const Eigen::Vector3d true_field_body_ut = truth.T_world_body.linear().transpose() * field_world_ut;
  const Eigen::Vector3d field_body_ut =
      soft_iron_ * true_field_body_ut + hard_iron_body_ut_ + noise_.gaussian_vector(config_.noise_ut);
  MagnetometerSample sample;
  sample.t_ns = truth.t_ns;
  sample.field_body_ut = converted(field_body_ut, config_.range_ut, config_.step_ut);
  return sample;
}

}  // namespace understory
