#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <vector>

#include "planning/airframe.hpp"
#include "sim/scene/trees.hpp"
#include "sim/scene/woods_mesh.hpp"
#include "sim/scene/world_config.hpp"

struct mjModel_;  // MuJoCo's, opaque to whoever does not include it
struct mjData_;
namespace understory {

struct DeleteModel {
  void operator()(mjModel_* model) const;
};
struct DeleteData {
  void operator()(mjData_* data) const;
};
using ModelPointer = std::unique_ptr<mjModel_, DeleteModel>;
using DataPointer = std::unique_ptr<mjData_, DeleteData>;

/// MuJoCo refuses a model or cannot continue with it: the numbers of an aircraft or a world do not fit
/// together.
struct SimulationError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Geom groups: collisions (never drawn), the scenery (drawn to everyone), the aircraft's skin (drawn only to
/// the chase camera: the stereo cameras look ahead of it).
enum GeomGroup { group_scenery = 0, group_aircraft_skin = 1, group_collision = 3 };

/// The compiled scene: ground, obstacles and one aircraft, at 1200 Hz with gravity. The aircraft's body is
/// named "aircraft" (free joint "aircraft_free"), its hinges "left_elevon" and "right_elevon", the ground's
/// geom "ground". The cameras paint the textures' pixels (sim/scene/scenery.hpp); physics does not need them.
struct World {
  ModelPointer model;  ///< what is drawn; it flies, too, where there is no other
  std::vector<Obstacle> obstacles;
  WorldConfig config = {};
  std::shared_ptr<WoodsMesh> woods = nullptr;  ///< what is drawn of woods; the cameras paint its textures
  /// Of a large course: what flies, without scenery and with pooled geoms. MuJoCo places every geom at every
  /// step, and a kilometre of forest has thousands.
  ModelPointer flown = {};

  mjModel_& flown_model() const { return flown ? *flown : *model; }
};

/// Number of capsules that can collide at a time in a world of woods or on a large course. The aircraft moves
/// them to the pieces of trees nearest to it. A wood has thousands of pieces, and MuJoCo checks every pair of
/// geoms.
inline constexpr int pooled_geoms = 64;

/// Whether it collides by the pool: trees of woods do, and everything round of a course of over 500
/// obstacles.
bool is_pooled(const Obstacle& obstacle, const std::vector<Obstacle>& all);

/// Composes models/airframe/delta_wing.xml with the obstacles and compiles it. Throws std::runtime_error,
/// naming the file, where MuJoCo refuses it. Mass and inertia come from `airframe`. With scenery `woods` the
/// model has the pooled geoms "pool_<number>" and no scenery: sim/render/woods_pass draws it. `course`
/// (corners in world axes, m) is where the aircraft may fly: stems and thickets of the far wood, which
/// nothing can hit, keep out of it. If it is empty they stand anywhere but among the trees.
World build_world(const std::filesystem::path& models_folder, const Airframe& airframe,
                  const std::vector<Obstacle>& obstacles, const WorldConfig& config,
                  const std::vector<Tree>& trees = {}, const Eigen::AlignedBox2d& course = {});

}  // namespace understory
