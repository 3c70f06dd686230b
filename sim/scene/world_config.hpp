#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace understory {

class FieldVisitor;

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

/// The look of the woods. A key that keeps its default is drawn from the scenario's seed, except
/// leaves_end_flight.
struct WoodsConfig {
  WoodsKinds kinds = WoodsKinds::any;
  Season season = Season::any;
  double lowest_branch_m = 0;
  bool has_low_crowns = false;  ///< no key: drawn() sets it where lowest_branch_m is given
  double undergrowth = -1;
  double fallen_logs = -1;
  double litter = -1;
  double leaf_tone = -1;
  double overcast = -1;
  double haze_m = 0;
  double sun_elevation_rad = 0;
  bool leaves_end_flight = false;
};

/// Contents and appearance of a scene.
struct WorldConfig {
  bool obstacles_visible = true;
  bool obstacles_tangible = true;
  double bark_contrast = 0.35;
  double ground_contrast = 0.30;
  std::uint64_t texture_seed = 1;
  Scenery scenery = Scenery::plain;
  WoodsConfig woods;
};

void visit_fields(FieldVisitor& visit, WorldConfig& config);

}  // namespace understory
