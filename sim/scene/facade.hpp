#pragma once

#include "sim/scene/obstacle.hpp"
#include "sim/scene/textures.hpp"
#include "sim/scene/trunk_mesh.hpp"

namespace understory {

// A wall's face: equal windows on plain plaster, one window a tile.
inline constexpr double window_period_m = 1.2;
inline constexpr double storey_m = 3.0;
inline constexpr int facade_width_px = 256;
inline constexpr int facade_height_px = 512;

/// One tile, the ground side last: a window of two by three panes in a pale frame between lintel and sill,
/// 0.75 x 1.7 m, one pane 0.375 m from the next. The plaster has almost no texture.
GrayTexture facade_texture(std::uint64_t seed);

/// A wall's box, in world axes with its foot at its from_world. Tiles begin at its middle and at its foot.
TrunkMesh facade_mesh(const Obstacle& wall);

}  // namespace understory
