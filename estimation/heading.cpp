#include "estimation/measurements.hpp"

#include <cmath>

namespace understory {

double horizontal_field_ut(const State& state, const MagnetometerSample& sample) {
  return (state.T_world_body.linear() * sample.field_body_ut).head<2>().norm();
}

Measurement<1> heading(const State& state, const MagnetometerSample& sample, const HeadingConfig& config) {
  const Eigen::Matrix3d attitude = state.T_world_body.linear();
  const Eigen::Vector3d field_world = attitude * sample.field_body_ut;
  Measurement<1> measurement;
  // North is world y. An estimate turned too far right shows the field turned right, towards +x.
  measurement.innovation[0] = std::atan2(field_world.x(), field_world.y());
  // A world-frame error e moves the field by e x field. The derivative is taken at the expected direction,
  // due north. At the measured direction its noise would enter the jacobian and look like information about
  // the tilt.
  const Eigen::RowVector3d by_world_error(0.0, -field_world.z() / field_world.head<2>().norm(), 1.0);
  measurement.jacobian.segment<3>(attitude_block) = by_world_error * attitude;
  measurement.noise(0, 0) = config.sigma_rad * config.sigma_rad;
  return measurement;
}

}  // namespace understory
