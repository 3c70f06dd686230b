#pragma once

#include <cstdint>
#include <vector>

namespace understory {

/// One mipmap level of a texture: red, green, blue, 8 bits each, rows without gaps.
struct TextureLevel {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb;
};

/// The mipmaps of a texture, each half as wide and high as the one before (a side of one pixel stays), down
/// to a single pixel. Neighbours in a row are averaged first, then two rows, each time rounded up. This
/// equals glGenerateMipmap of llvmpipe (Mesa 22.3.6) bit for bit, without 0.1 s of compiling shaders, and is
/// the same on every renderer. Sides must be powers of two.
std::vector<TextureLevel> smaller_copies(int width_px, int height_px, const std::uint8_t* rgb);

}  // namespace understory
