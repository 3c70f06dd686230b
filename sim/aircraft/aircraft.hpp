#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "planning/airframe.hpp"
#include "sim/aircraft/actuators.hpp"
#include "sim/aircraft/aerodynamics.hpp"
#include "sim/aircraft/aircraft_config.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/aircraft/wind.hpp"
#include "sim/scene/ground_cells.hpp"
#include "sim/scene/world.hpp"

namespace understory {

enum class Contact { none, ground, obstacle };

/// What the aircraft touches, by MuJoCo's own contacts at one step.
struct Touch {
  Contact with = Contact::none;  ///< an obstacle has priority over the ground
  std::string part = {};         ///< of the aircraft, as its model names it: "left_wing_outer"
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();
};

/// A box that collides. Its axes are the body's.
struct AircraftPart {
  std::string name;
  Eigen::Vector3d centre_body = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
};

/// The visible shape of the aircraft without its elevons, and its parts that collide, in its body frame, m.
struct AircraftShape {
  std::vector<Eigen::Vector3d> vertices_body;
  std::vector<Eigen::Vector3i> faces;
  std::vector<AircraftPart> parts;
};

/// The delta wing in the world: MuJoCo integrates its body at 1200 Hz under the identified flat-plate
/// aerodynamics, in the air that `wind` makes.
///
/// On the rail the body rests for rest_s, then accelerates evenly from rail_length_m before the release
/// point. It is pitched above the rail by the angle of attack of level trim at the release speed, so it
/// leaves with enough lift and without rotation. Elevons and motor follow their commands after the input
/// delay with the dynamics of `actuators`, by default at once and in full.
class Aircraft {
 public:
  /// Keeps a reference to the model. The launch rail points along world x; the release point is the world's
  /// (0, 0). Throws std::runtime_error where the rail would begin underground. The time step is the model's
  /// (1/1200 s from build_world; tests of convergence set others, whole numbers of hertz). `pooled`: the
  /// obstacles of a model with pooled geoms (build_world), for which the pieces of its trees take turns;
  /// empty for other models. Such a model serves one aircraft.
  Aircraft(mjModel_& model, const Airframe& airframe, const LaunchConfig& launch, Wind wind,
           const ActuatorsConfig& actuators = {}, const std::vector<Obstacle>& pooled = {});
  /// In a steady wind.
  Aircraft(mjModel_& model, const Airframe& airframe, const LaunchConfig& launch,
           const Eigen::Vector3d& wind_world_mps)
      : Aircraft(model, airframe, launch, Wind(wind_world_mps)) {}

  /// Advances one physics step. Controls act one input delay later, limited to the airframe's range. On the
  /// rail the body follows the rail, regardless of the controls. Afterwards kinematics and contacts in data()
  /// are those of the new moment. Throws std::logic_error on controls that are not finite.
  void step(const Controls& controls);

  /// The same, but the body is carried to this pose and motion, whatever the air does.
  void carry(const Eigen::Isometry3d& T_world_body, const Eigen::Vector3d& velocity_world_mps,
             const Eigen::Vector3d& angular_rate_body_radps, const Controls& controls);

  /// The acceleration in truth() is the mean over the step just taken.
  const Truth& truth() const { return truth_; }
  bool launched() const { return step_ >= release_step_; }  ///< has left the rail
  Touch touch() const;
  Contact contact() const { return touch().with; }
  AircraftShape shape() const;
  const mjData_& data() const { return *data_; }

  /// Places the body in flight, with surfaces and delayed commands at `controls`, for tests and experiments
  /// that start in the air. Time continues.
  void place(const Eigen::Isometry3d& T_world_body, const Eigen::Vector3d& velocity_world_mps,
             const Eigen::Vector3d& angular_rate_body_radps, const Controls& controls);

 private:
  /// An obstacle's collision capsule.
  struct NearObstacle {
    Eigen::Vector3d centre_world;
    Eigen::Vector3d axis_world;
    double half_length_m;
    double radius_m;
    /// Whether a sphere about `centre` reaches it.
    bool is_near(const Eigen::Vector3d& centre, double reach_m) const;
  };

  std::int64_t t_ns() const { return step_ * 1'000'000'000 / rate_hz_; }
  void read_outline();
  void read_pool(const std::vector<Obstacle>& pooled);
  GroundCells<NearObstacle> by_cells(const std::vector<NearObstacle>& obstacles) const;
  bool anything_near();
  void place_pool(const std::vector<const NearObstacle*>& near);
  void update_moment();
  Controls delayed(const Controls& controls);
  void follow_rail();
  AirState air() const;
  void fly();
  void set_body(const Eigen::Isometry3d& T_world_body, const Eigen::Vector3d& velocity_world_mps,
                const Eigen::Vector3d& angular_rate_body_radps);
  void set_elevons();
  void read_truth(const Eigen::Vector3d& rail_acceleration_world_mps2);

  mjModel_& model_;
  DataPointer data_;
  Airframe airframe_;
  LaunchConfig launch_;
  Wind wind_;
  Actuators actuators_;
  std::int64_t rate_hz_;
  double step_s_;
  Eigen::Quaterniond rail_attitude_ = Eigen::Quaterniond::Identity();
  std::vector<Controls> delay_line_;  ///< a ring, one entry a step
  std::int64_t step_ = 0;
  std::int64_t rest_steps_ = 0;
  std::int64_t release_step_ = 0;
  int body_ = 0;
  int ground_geom_ = 0;
  double reach_m_ = 0;  ///< from the centre of mass to the farthest corner of the collision boxes
  GroundCells<NearObstacle> obstacles_;
  /// Of a model with pooled geoms: the pieces of its trees, and the pool's first geom.
  GroundCells<NearObstacle> pieces_;
  int pooled_ = 0;  ///< geoms of the pool that lie at an obstacle now
  int first_pooled_ = -1;
  Truth truth_;
};

}  // namespace understory
