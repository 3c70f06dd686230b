#include "scenarios/validation/free_flight.hpp"

namespace understory {
FreeFlight::FreeFlight(const std::filesystem::path& models_folder, const Airframe& airframe)
    : world_(build_world(models_folder, airframe, {}, WorldConfig{})) {}

Aircraft FreeFlight::begin(const Airframe& airframe, const AirborneStart& start) const {
  Aircraft aircraft(*world_.model, airframe, LaunchConfig{}, Eigen::Vector3d::Zero());
  Eigen::Isometry3d pose(start.R_world_body);
  pose.translation() = Eigen::Vector3d(0, 0, start_altitude_m);
  aircraft.place(pose, start.R_world_body * start.velocity_body_mps, start.angular_rate_body_radps,
                 start.controls);
  return aircraft;
}

}  // namespace understory
