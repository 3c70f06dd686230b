#pragma once

#include <cstdint>
#include <vector>

namespace understory {

enum class WoodsTexture { oak, beech, birch, pine, spruce, ground, leaves };
inline constexpr std::size_t woods_texture_count = 7;

/// Red, green, blue, alpha; rows from the bottom up; sides are powers of two.
struct WoodsPicture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgba;
};

/// Bark of a kind, litter, or the four pictures of leaves (two sprays of leaves, needles, a fern, a quarter
/// each). The same seed gives the same picture.
WoodsPicture woods_picture(WoodsTexture which, std::uint32_t seed);

/// Patches of sun between shade; one tile is 16 x 16 m of ground.
WoodsPicture dapple_picture(std::uint32_t seed);

}  // namespace understory
