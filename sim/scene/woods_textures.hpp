#pragma once

#include <cstdint>
#include <vector>

namespace understory {

enum class WoodsTexture { oak, beech, birch, pine, spruce, windows, ground, leaves };
inline constexpr std::size_t woods_texture_count = 8;

/// What the texture of leaves shows, a quarter of its width and half of its height each, row by row from
/// below. All but the first three stand on their lower edge.
enum class LeafPicture { leaves, more_leaves, needles, twigs, frond, fern, grass, thicket };

/// Red, green, blue, alpha; rows from the bottom up; sides are powers of two.
struct WoodsPicture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgba;
};

/// Bark of a kind, a wall's windows, litter with patches of sun, or leaves. The same arguments give the same
/// picture.
WoodsPicture woods_picture(WoodsTexture which, std::uint32_t seed, double overcast);

/// Patches of sun between shade; 128 leaves a colour as it is. `overcast` 1: none. One tile is a square of
/// the ground, and so is one tile of litter.
WoodsPicture dapple_picture(std::uint32_t seed, double overcast);
inline constexpr double dapple_tile_m = 16;

}  // namespace understory
