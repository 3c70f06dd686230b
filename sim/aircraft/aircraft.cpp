#include "sim/aircraft/aircraft.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim/aircraft/aerodynamics.hpp"

namespace understory {
namespace {

Eigen::Map<Eigen::Vector3d> vector_at(mjtNum* numbers) { return Eigen::Map<Eigen::Vector3d>(numbers); }

/// Nose up turns about body -y.
Eigen::Quaterniond pitched_up(double pitch_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(-pitch_rad, Eigen::Vector3d::UnitY()));
}

Controls within_limits(const Controls& controls, const Airframe& airframe) {
  if (!std::isfinite(controls.left_elevon_rad) || !std::isfinite(controls.right_elevon_rad) ||
      !std::isfinite(controls.thrust_n)) {
    throw SimulationError("the controls are not finite");
  }
  return {std::clamp(controls.left_elevon_rad, airframe.elevon_min_rad, airframe.elevon_max_rad),
          std::clamp(controls.right_elevon_rad, airframe.elevon_min_rad, airframe.elevon_max_rad),
          std::clamp(controls.thrust_n, 0.0, airframe.max_thrust_n)};
}

/// Where geoms of the pool wait (build_world).
constexpr double pool_below_m = -500;

}  // namespace

Aircraft::Aircraft(mjModel& model, const Airframe& airframe, const LaunchConfig& launch, Wind wind,
                   const ActuatorsConfig& actuators, const std::vector<Obstacle>& pooled)
    : model_(model),
      data_(mj_makeData(&model)),
      airframe_(airframe),
      launch_(launch),
      wind_(std::move(wind)),
      actuators_(actuators),
      rate_hz_(std::llround(1 / model.opt.timestep)),
      step_s_(1.0 / static_cast<double>(rate_hz_)),
      body_(mj_name2id(&model, mjOBJ_BODY, "aircraft")),
      ground_geom_(mj_name2id(&model, mjOBJ_GEOM, "ground")) {
  const double rail_start_m = launch.altitude_m - launch.rail_length_m * std::sin(launch.climb_angle_rad);
  if (rail_start_m < 0) throw std::runtime_error("launch: the rail begins underground; raise altitude_m");
  const double acceleration_s = 2 * launch.rail_length_m / launch.speed_mps;
  const auto steps_in = [this](double time_s) {
    return std::llround(time_s * static_cast<double>(rate_hz_));
  };
  rest_steps_ = steps_in(launch.rest_s);
  release_step_ = rest_steps_ + std::max<std::int64_t>(1, steps_in(acceleration_s));
  rail_attitude_ =
      pitched_up(launch.climb_angle_rad + release_angle_of_attack_rad(airframe, launch.speed_mps));
  read_outline();
  read_pool(pooled);
  delay_line_.resize(1 + static_cast<std::size_t>(steps_in(airframe.input_delay_s)));
  follow_rail();
  update_moment();
  read_truth(Eigen::Vector3d::Zero());
}

void Aircraft::step(const Controls& controls) {
  actuators_.advance(delayed(within_limits(controls, airframe_)), step_s_);
  const Eigen::Vector3d velocity_before = truth_.velocity_world_mps;
  const bool on_rail = !launched();
  ++step_;
  if (on_rail) {
    follow_rail();
  } else {
    fly();
  }
  set_elevons();
  update_moment();
  const Eigen::Vector3d velocity_now = vector_at(data_->qvel);
  wind_.advance(t_ns(), step_s_, vector_at(data_->qpos), velocity_now);
  read_truth((velocity_now - velocity_before) / step_s_);
}

void Aircraft::carry(const Eigen::Isometry3d& T_world_body, const Eigen::Vector3d& velocity_world_mps,
                     const Eigen::Vector3d& angular_rate_body_radps, const Controls& controls) {
  actuators_.advance(delayed(within_limits(controls, airframe_)), step_s_);
  const Eigen::Vector3d force_world_mps2 = (velocity_world_mps - truth_.velocity_world_mps) / step_s_ +
                                           Eigen::Vector3d(0, 0, airframe_.gravity_mps2);
  ++step_;
  data_->time = static_cast<double>(step_) * step_s_;
  set_body(T_world_body, velocity_world_mps, angular_rate_body_radps);
  set_elevons();
  update_moment();
  wind_.advance(t_ns(), step_s_, vector_at(data_->qpos), velocity_world_mps);
  read_truth(Eigen::Vector3d::Zero());
  // Across the body the air's own force: the planner's model turns about the nose a little otherwise than a
  // body does, and a filter that reads sideslip from that force would drift.
  const double lateral_mps2 = truth_.specific_force_body_mps2.y();
  truth_.specific_force_body_mps2 = truth_.T_world_body.linear().transpose() * force_world_mps2;
  truth_.specific_force_body_mps2.y() = lateral_mps2;
}

void Aircraft::read_outline() {
  std::vector<NearObstacle> obstacles;
  for (int geom = 0; geom < model_.ngeom; ++geom) {
    const Eigen::Map<const Eigen::Vector3d> centre(model_.geom_pos + 3 * geom);
    if (model_.geom_bodyid[geom] == body_ && model_.geom_contype[geom] != 0) {
      reach_m_ = std::max(reach_m_, centre.norm() + model_.geom_rbound[geom]);
    } else if (model_.geom_type[geom] == mjGEOM_CAPSULE && model_.geom_conaffinity[geom] != 0) {
      if (centre.z() < pool_below_m) continue;
      const mjtNum* turn = model_.geom_quat + 4 * geom;
      const Eigen::Vector3d axis =
          Eigen::Quaterniond(turn[0], turn[1], turn[2], turn[3]) * Eigen::Vector3d::UnitZ();
      const mjtNum* size = model_.geom_size + 3 * geom;  // radius, half length
      obstacles.push_back({centre, axis, size[1], size[0]});
    } else if ((model_.geom_type[geom] == mjGEOM_BOX || model_.geom_type[geom] == mjGEOM_SPHERE) &&
               model_.geom_conaffinity[geom] != 0) {
      obstacles.push_back(
          {centre, Eigen::Vector3d::UnitZ(), 0, model_.geom_rbound[geom]});  // a wall: its sphere
    }
  }
  obstacles_ = by_cells(obstacles);
}

AircraftShape Aircraft::shape() const {
  AircraftShape shape;
  for (int geom = 0; geom < model_.ngeom; ++geom) {
    if (model_.geom_bodyid[geom] != body_) continue;
    const Eigen::Vector3d centre(model_.geom_pos + 3 * geom);
    if (model_.geom_contype[geom] != 0)
      shape.parts.push_back(
          {model_.names + model_.name_geomadr[geom], centre, Eigen::Vector3d(model_.geom_size + 3 * geom)});
    if (model_.geom_type[geom] != mjGEOM_MESH) continue;
    const mjtNum* turn = model_.geom_quat + 4 * geom;
    const Eigen::Quaterniond attitude(turn[0], turn[1], turn[2], turn[3]);
    const int mesh = model_.geom_dataid[geom], first = static_cast<int>(shape.vertices_body.size());
    const float* vertices = model_.mesh_vert + 3 * model_.mesh_vertadr[mesh];
    for (int i = 0; i < model_.mesh_vertnum[mesh]; ++i)
      shape.vertices_body.push_back(centre + attitude * Eigen::Vector3f(vertices + 3 * i).cast<double>());
    const int* faces = model_.mesh_face + 3 * model_.mesh_faceadr[mesh];
    for (int i = 0; i < model_.mesh_facenum[mesh]; ++i)
      shape.faces.emplace_back(Eigen::Vector3i(faces + 3 * i).array() + first);
  }
  return shape;
}

bool Aircraft::NearObstacle::is_near(const Eigen::Vector3d& centre, double reach_m) const {
  const Eigen::Vector3d offset = centre - centre_world;
  const double along_m = std::clamp(offset.dot(axis_world), -half_length_m, half_length_m);
  const double near_m = reach_m + radius_m;
  return (offset - along_m * axis_world).squaredNorm() < near_m * near_m;
}

/// Each obstacle into the cell of its centre. The aircraft reaches none beyond the next cell.
GroundCells<Aircraft::NearObstacle> Aircraft::by_cells(const std::vector<NearObstacle>& obstacles) const {
  double cell_m = 1;
  for (const NearObstacle& obstacle : obstacles)
    cell_m = std::max(
        cell_m, reach_m_ + obstacle.half_length_m * obstacle.axis_world.head<2>().norm() + obstacle.radius_m);
  GroundCells<NearObstacle> cells(cell_m);
  for (const NearObstacle& obstacle : obstacles) cells.add(obstacle.centre_world, obstacle);
  return cells;
}

void Aircraft::read_pool(const std::vector<Obstacle>& pooled) {
  first_pooled_ = mj_name2id(&model_, mjOBJ_GEOM, "pool_0");
  if (first_pooled_ < 0) return;
  std::vector<NearObstacle> pieces;
  for (const Obstacle& obstacle : pooled) {
    if (!is_pooled(obstacle, pooled)) continue;
    const Eigen::Vector3d half = 0.5 * (obstacle.to_world - obstacle.from_world);
    pieces.push_back({obstacle.from_world + half, half.normalized(), half.norm(), obstacle.radius_m});
  }
  pieces_ = by_cells(pieces);
}

bool Aircraft::anything_near() {
  const Eigen::Map<const Eigen::Vector3d> centre(data_->qpos);
  const auto is_near = [&](const NearObstacle& obstacle) { return obstacle.is_near(centre, reach_m_); };
  const bool fixed_near = centre.z() < reach_m_ || obstacles_.any_around(centre, is_near);
  if (first_pooled_ < 0) return fixed_near;
  std::vector<const NearObstacle*> near;
  pieces_.any_around(centre, [&](const NearObstacle& piece) {
    if (is_near(piece)) near.push_back(&piece);
    return false;
  });
  place_pool(near);
  return fixed_near || !near.empty();
}

/// MuJoCo's geoms of the pool take place and size of these obstacles; the others go below the ground.
void Aircraft::place_pool(const std::vector<const NearObstacle*>& near) {
  if (near.size() > pooled_geoms)
    throw SimulationError("more than " + std::to_string(pooled_geoms) +
                          " branches within the aircraft's reach");
  for (std::size_t i = 0; i < near.size(); ++i) {
    const auto geom = static_cast<std::size_t>(first_pooled_) + i;
    const NearObstacle& obstacle = *near[i];
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), obstacle.axis_world);
    vector_at(model_.geom_pos + 3 * geom) = obstacle.centre_world;
    model_.geom_quat[4 * geom] = turn.w();
    vector_at(model_.geom_quat + 4 * geom + 1) = turn.vec();
    model_.geom_size[3 * geom] = obstacle.radius_m;
    model_.geom_size[3 * geom + 1] = obstacle.half_length_m;
    model_.geom_rbound[geom] = obstacle.half_length_m + obstacle.radius_m;
  }
  for (int i = static_cast<int>(near.size()); i < pooled_; ++i)
    vector_at(model_.geom_pos + 3 * (first_pooled_ + i)) = Eigen::Vector3d(0, 0, 2 * pool_below_m);
  pooled_ = static_cast<int>(near.size());
}

/// Kinematics, contacts and velocity terms of the new step: mj_step1. MuJoCo checks every pair of geoms,
/// which in a forest costs more than everything else. Where no obstacle is within reach, only the collision
/// stage is skipped; there would be no contacts.
void Aircraft::update_moment() {
  mjData* data = data_.get();
  if (anything_near()) {
    mj_step1(&model_, data);
    return;
  }
  mj_kinematics(&model_, data);
  mj_comPos(&model_, data);
  mj_camlight(&model_, data);
  mj_crb(&model_, data);
  mj_factorM(&model_, data);
  data->ncon = 0;
  mj_makeConstraint(&model_, data);
  mj_transmission(&model_, data);
  mj_fwdVelocity(&model_, data);
}

Controls Aircraft::delayed(const Controls& controls) {
  const std::int64_t size = static_cast<std::int64_t>(delay_line_.size());
  delay_line_[static_cast<std::size_t>(step_ % size)] = controls;
  return delay_line_[static_cast<std::size_t>((step_ + 1) % size)];
}

/// Constant acceleration that ends exactly at the release point, with the release speed, on the release step.
void Aircraft::follow_rail() {
  const double duration_s = static_cast<double>(release_step_ - rest_steps_) * step_s_;
  const double elapsed_s = static_cast<double>(std::max<std::int64_t>(0, step_ - rest_steps_)) * step_s_;
  const double acceleration_mps2 = launch_.speed_mps / duration_s;
  const double from_release_m = 0.5 * acceleration_mps2 * (elapsed_s * elapsed_s - duration_s * duration_s);
  const Eigen::Vector3d rail_world(std::cos(launch_.climb_angle_rad), 0, std::sin(launch_.climb_angle_rad));
  Eigen::Isometry3d pose(rail_attitude_);
  pose.translation() = Eigen::Vector3d(0, 0, launch_.altitude_m) + from_release_m * rail_world;
  set_body(pose, acceleration_mps2 * elapsed_s * rail_world, Eigen::Vector3d::Zero());
  data_->time = static_cast<double>(step_) * step_s_;
}

/// The air as the wing meets it at truth_, with the present positions of the actuators.
AirState Aircraft::air() const {
  AirState air;
  air.air_velocity_body_mps =
      truth_.T_world_body.linear().transpose() * (truth_.velocity_world_mps - truth_.wind_world_mps);
  air.angular_rate_body_radps = truth_.angular_rate_body_radps;
  const double forward_mps = air.air_velocity_body_mps.x();
  air.left_elevon_rad = actuators_.left_elevon_rad();
  air.right_elevon_rad = actuators_.right_elevon_rad();
  air.thrust_n = actuators_.thrust_n(forward_mps);
  air.motor_torque_nm = actuators_.motor_torque_nm(forward_mps);
  air.elevon_wash_mps = actuators_.elevon_wash_mps(forward_mps, airframe_.air_density_kgpm3);
  return air;
}

void Aircraft::fly() {
  const Eigen::Matrix3d R_world_body = truth_.T_world_body.linear();
  const Wrench wrench = aerodynamic_wrench(airframe_, air());
  mjtNum* applied = data_->xfrc_applied + 6 * body_;  // at the centre of mass, world axes
  vector_at(applied) = R_world_body * wrench.force_body_n;
  vector_at(applied + 3) = R_world_body * wrench.moment_body_nm;
  mj_step2(&model_, data_.get());
}

void Aircraft::set_body(const Eigen::Isometry3d& T_world_body, const Eigen::Vector3d& velocity_world_mps,
                        const Eigen::Vector3d& angular_rate_body_radps) {
  const Eigen::Quaterniond attitude(T_world_body.linear());
  vector_at(data_->qpos) = T_world_body.translation();
  data_->qpos[3] = attitude.w();
  vector_at(data_->qpos + 4) = attitude.vec();
  vector_at(data_->qvel) = velocity_world_mps;
  vector_at(data_->qvel + 3) = angular_rate_body_radps;
}

/// The hinges are positioned, not simulated. The servos' dynamics are in the actuators.
void Aircraft::set_elevons() {
  const auto set = [this](const char* name, double angle_rad) {
    const int joint = mj_name2id(&model_, mjOBJ_JOINT, name);
    data_->qpos[model_.jnt_qposadr[joint]] = angle_rad;
    data_->qvel[model_.jnt_dofadr[joint]] = 0;
  };
  set("left_elevon", actuators_.left_elevon_rad());
  set("right_elevon", actuators_.right_elevon_rad());
}

void Aircraft::read_truth(const Eigen::Vector3d& rail_acceleration_world_mps2) {
  const mjtNum* position = data_->qpos;
  const Eigen::Quaterniond attitude(position[3], position[4], position[5], position[6]);
  truth_.t_ns = t_ns();
  truth_.T_world_body = Eigen::Isometry3d(attitude.normalized());
  truth_.T_world_body.translation() = Eigen::Map<const Eigen::Vector3d>(position);
  truth_.velocity_world_mps = vector_at(data_->qvel);
  truth_.angular_rate_body_radps = vector_at(data_->qvel + 3);
  truth_.wind_world_mps = wind_.at(truth_.T_world_body.translation());
  const AirState felt = air();
  if (step_ > release_step_) {
    // The present force of the air. A difference of velocities would belong to the previous step, in axes
    // that have turned since; in a dodge the estimator would integrate that to 0.1 m/s.
    truth_.specific_force_body_mps2 = aerodynamic_wrench(airframe_, felt).force_body_n / airframe_.mass_kg;
  } else {
    const Eigen::Vector3d gravity_world(0, 0, -airframe_.gravity_mps2);
    truth_.specific_force_body_mps2 =
        truth_.T_world_body.linear().transpose() * (rail_acceleration_world_mps2 - gravity_world);
  }
  truth_.left_elevon_rad = felt.left_elevon_rad;
  truth_.right_elevon_rad = felt.right_elevon_rad;
  truth_.thrust_n = felt.thrust_n;
}

Touch Aircraft::touch() const {
  Touch found;
  if (!launched()) return found;  // the rail holds it
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    const bool is_ground = contact.geom1 == ground_geom_ || contact.geom2 == ground_geom_;
    if (is_ground && found.with != Contact::none) continue;
    const bool first_is_ours = model_.body_rootid[model_.geom_bodyid[contact.geom1]] == body_;
    const int part = first_is_ours ? contact.geom1 : contact.geom2;
    found = {is_ground ? Contact::ground : Contact::obstacle, model_.names + model_.name_geomadr[part],
             Eigen::Vector3d(contact.pos)};
    if (!is_ground) return found;
  }
  return found;
}

void Aircraft::place(const Eigen::Isometry3d& T_world_body, const Eigen::Vector3d& velocity_world_mps,
                     const Eigen::Vector3d& angular_rate_body_radps, const Controls& controls) {
  const Controls held = within_limits(controls, airframe_);
  actuators_.settle(held);
  std::fill(delay_line_.begin(), delay_line_.end(), held);
  release_step_ = std::min(release_step_, step_);
  rest_steps_ = std::min(rest_steps_, release_step_);
  set_body(T_world_body, velocity_world_mps, angular_rate_body_radps);
  set_elevons();
  update_moment();
  read_truth(Eigen::Vector3d::Zero());
}

}  // namespace understory
