#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace understory {

/// The physics counts whole steps: time never drifts and is never compared as a float.
constexpr int physics_rate_hz = 1200;
constexpr std::int64_t time_of_step_ns(std::int64_t step) { return step * 1'000'000'000 / physics_rate_hz; }

enum class Scenery { plain, woods };
enum class WoodsKinds { any, mixed, oak, beech, birch, pine, spruce };

inline constexpr std::array<std::pair<std::string_view, Scenery>, 2> scenery_names{
    {{"plain", Scenery::plain}, {"woods", Scenery::woods}}};
inline constexpr std::array<std::pair<std::string_view, WoodsKinds>, 7> woods_kinds_names{
    {{"any", WoodsKinds::any},
     {"mixed", WoodsKinds::mixed},
     {"oak", WoodsKinds::oak},
     {"beech", WoodsKinds::beech},
     {"birch", WoodsKinds::birch},
     {"pine", WoodsKinds::pine},
     {"spruce", WoodsKinds::spruce}}};

/// The look of the woods. A key that keeps its default is drawn from the scenario's seed.
struct WoodsConfig {
  WoodsKinds kinds = WoodsKinds::any;  ///< kind of all trees; mixed: all five; any: drawn from the seed
  double lowest_branch_m = 0;    ///< m: height below which no living branch begins; 0: drawn from 6 to 8
  double undergrowth = -1;       ///< density of ferns and shrubs, 0 to 1; negative: drawn from 0.2 to 1
  double haze_m = 0;             ///< distance at which haze hides two thirds; 0: drawn from 60 to 250
  double sun_elevation_rad = 0;  ///< height of the sun over the horizon; 0: drawn from 0.5 to 1.2
};

template <typename Visitor>
void visit_fields(Visitor& visit, WoodsConfig& config) {
  visit("kinds", config.kinds, woods_kinds_names);
  visit("lowest_branch_m", config.lowest_branch_m, 0.0, 40.0);
  visit("undergrowth", config.undergrowth, -1.0, 1.0);
  visit("haze_m", config.haze_m, 0.0, 10000.0);
  visit("sun_elevation_rad", config.sun_elevation_rad, 0.0, 1.5);
}

/// Contents and appearance of a scene.
struct WorldConfig {
  bool obstacles_visible = true;   ///< draws the obstacles (forest.invisible is the key)
  bool obstacles_tangible = true;  ///< lets the aircraft collide (forest.intangible is the key)
  /// Standard deviation of the bark's brightness divided by its mean (models/textures/README.md).
  double bark_contrast = 0.35;
  double ground_contrast = 0.30;  ///< standard deviation of the ground's brightness divided by its mean
  /// seed of the textures, separate from `seed`: all flights have the same textures
  std::uint64_t texture_seed = 1;
  /// What is drawn: textured cylinders on a plain, or trees with branches and crowns on a forest floor.
  Scenery scenery = Scenery::plain;
  WoodsConfig woods;
};

template <typename Visitor>
void visit_fields(Visitor& visit, WorldConfig& config) {
  visit("obstacles_visible", config.obstacles_visible);
  visit("obstacles_tangible", config.obstacles_tangible);
  visit("bark_contrast", config.bark_contrast, 0.0, 1.0);
  visit("ground_contrast", config.ground_contrast, 0.0, 1.0);
  visit("texture_seed", config.texture_seed, std::uint64_t{0}, std::uint64_t{1} << 32);
  visit("scenery", config.scenery, scenery_names);
  visit("woods", config.woods);
}

}  // namespace understory
