#pragma once

#include <cstdint>

namespace understory {

/// The physics counts whole steps: time never drifts and is never compared as a float.
constexpr int physics_rate_hz = 1200;
constexpr std::int64_t time_of_step_ns(std::int64_t step) { return step * 1'000'000'000 / physics_rate_hz; }

/// Contents and appearance of a scene.
struct WorldConfig {
  bool obstacles_visible = true;   ///< draws the obstacles (forest.invisible is the key)
  bool obstacles_tangible = true;  ///< lets the aircraft collide (forest.intangible is the key)
  /// Standard deviation of the bark's brightness over its mean (models/README.md).
  double bark_contrast = 0.35;
  double ground_contrast = 0.30;   ///< standard deviation of the ground's brightness over its mean
  std::uint64_t texture_seed = 1;  ///< seed of the textures; the same for all flights
};

template <typename Visitor>
void visit_fields(Visitor& visit, WorldConfig& config) {
  visit("obstacles_visible", config.obstacles_visible);
  visit("obstacles_tangible", config.obstacles_tangible);
  visit("bark_contrast", config.bark_contrast, 0.0, 1.0);
  visit("ground_contrast", config.ground_contrast, 0.0, 1.0);
  visit("texture_seed", config.texture_seed, std::uint64_t{0}, std::uint64_t{1} << 32);
}

}  // namespace understory
