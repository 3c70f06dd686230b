#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "planning/airframe.hpp"
#include "sim/scene/obstacle.hpp"

struct mjModel_;  // MuJoCo's, opaque to whoever does not include it
struct mjData_;

namespace understory {

/// Contents and look of a scene.
struct WorldConfig {
  bool obstacles_visible = true;   ///< false: they collide and are not drawn (proof against self-deception)
  bool obstacles_tangible = true;  ///< false: drawn, and harmless
  double bark_contrast =
      0.35;  ///< standard deviation of the bark's brightness over its mean; frozen, see models/README
  double ground_contrast = 0.30;   ///< the same of the ground
  std::uint64_t texture_seed = 1;  ///< of the procedural noise, not of a flight
};

template <typename Visitor>
void visit_fields(Visitor& visit, WorldConfig& config) {
  visit("obstacles_visible", config.obstacles_visible);
  visit("obstacles_tangible", config.obstacles_tangible);
  visit("bark_contrast", config.bark_contrast, 0.0, 1.0);
  visit("ground_contrast", config.ground_contrast, 0.0, 1.0);
  visit("texture_seed", config.texture_seed, std::uint64_t{0}, std::uint64_t{1} << 32);
}

struct DeleteModel {
  void operator()(mjModel_* model) const;
};
struct DeleteData {
  void operator()(mjData_* data) const;
};
using ModelPointer = std::unique_ptr<mjModel_, DeleteModel>;
using DataPointer = std::unique_ptr<mjData_, DeleteData>;

/// Geom groups: collisions (never drawn), the scenery (drawn to everyone), the aircraft's skin (drawn only to
/// the chase camera: the stereo cameras look ahead of it).
enum GeomGroup { group_scenery = 0, group_aircraft_skin = 1, group_collision = 3 };

/// The compiled scene: ground, obstacles and one aircraft, at 1200 Hz with gravity. The aircraft's body is
/// named "aircraft" (free joint "aircraft_free"), its hinges "left_elevon" and "right_elevon", the ground's
/// geom "ground". The cameras paint the textures' pixels (sim/scene/scenery.hpp); physics does not need them.
struct World {
  ModelPointer model;
  std::vector<Obstacle> obstacles;
  WorldConfig config = {};
};

/// Composes models/airframe/delta_wing.xml with the obstacles and compiles it. Throws std::runtime_error,
/// naming the file, where MuJoCo refuses it. Mass and inertia come from `airframe`.
World build_world(const std::filesystem::path& models_folder, const Airframe& airframe,
                  const std::vector<Obstacle>& obstacles, const WorldConfig& config);

constexpr int physics_rate_hz = 1200;
constexpr std::int64_t time_of_step_ns(std::int64_t step) { return step * 1'000'000'000 / physics_rate_hz; }

}  // namespace understory
