#include "scenarios/recording/carried_truth.hpp"

namespace understory {

Truth carried_truth(const CarriedPose& pose_at, std::int64_t t_ns, double gravity_mps2) {
  constexpr double h_s = 1e-4;
  const double t_s = static_cast<double>(t_ns) * 1e-9;
  const Eigen::Isometry3d before = pose_at(t_s - h_s), now = pose_at(t_s), after = pose_at(t_s + h_s);
  Truth truth;
  truth.t_ns = t_ns;
  truth.T_world_body = now;
  truth.velocity_world_mps = (after.translation() - before.translation()) / (2 * h_s);
  const Eigen::AngleAxisd turned(Eigen::Matrix3d(before.linear().transpose() * after.linear()));
  truth.angular_rate_body_radps = turned.angle() * turned.axis() / (2 * h_s);
  const Eigen::Vector3d acceleration_world_mps2 =
      (after.translation() - 2 * now.translation() + before.translation()) / (h_s * h_s);
  truth.specific_force_body_mps2 =
      now.linear().transpose() * (acceleration_world_mps2 + gravity_mps2 * Eigen::Vector3d::UnitZ());
  return truth;
}

}  // namespace understory
