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
enum class Season { any, summer, winter };

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
inline constexpr std::array<std::pair<std::string_view, Season>, 3> season_names{
    {{"any", Season::any}, {"summer", Season::summer}, {"winter", Season::winter}}};

/// The look of the woods. A key that keeps its default is drawn from the scenario's seed.
struct WoodsConfig {
  WoodsKinds kinds = WoodsKinds::any;  ///< kind of all trees; mixed: all five; any: drawn from the seed
  /// winter: oaks, beeches and birches have no leaves; any: drawn from the seed, winter once in four
  Season season = Season::any;
  double lowest_branch_m = 0;    ///< height below which no living branch begins; 0: drawn from 6 to 8
  double undergrowth = -1;       ///< density of ferns and shrubs, 0 to 1; negative: drawn from 0.2 to 1
  double fallen_logs = -1;       ///< number of fallen logs per hectare; negative: drawn from 0 to 80
  double litter = -1;            ///< share of the ground under dead leaves instead of moss; negative: drawn
  double leaf_tone = -1;         ///< colour of the leaves from fresh (0) to dark (1); negative: drawn
  double overcast = -1;          ///< share of the sun that clouds take, 1: no patches of sun; negative: drawn
  double haze_m = 0;             ///< distance at which haze hides two thirds; 0: drawn from 60 to 250
  double sun_elevation_rad = 0;  ///< height of the sun over the horizon; 0: drawn from 0.15 to 1.2
  /// ends a flight when the wing touches a leaf; otherwise leaves do not stop the aircraft
  bool leaves_end_flight = false;
};

template <typename Visitor>
void visit_fields(Visitor& visit, WoodsConfig& config) {
  visit("kinds", config.kinds, woods_kinds_names);
  visit("season", config.season, season_names);
  visit("lowest_branch_m", config.lowest_branch_m, 0.0, 40.0);
  visit("undergrowth", config.undergrowth, -1.0, 1.0);
  visit("fallen_logs", config.fallen_logs, -1.0, 1000.0);
  visit("litter", config.litter, -1.0, 1.0);
  visit("leaf_tone", config.leaf_tone, -1.0, 1.0);
  visit("overcast", config.overcast, -1.0, 1.0);
  visit("haze_m", config.haze_m, 0.0, 10000.0);
  visit("sun_elevation_rad", config.sun_elevation_rad, 0.0, 1.5);
  visit("leaves_end_flight", config.leaves_end_flight);
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
