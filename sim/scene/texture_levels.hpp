#pragma once

#include <cstdint>
#include <vector>

namespace understory {

/// One level of a texture's pyramid: red, green, blue, 8 bits each, row after row without gaps.
struct TextureLevel {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb;
};

/// The smaller copies of a texture, each half as wide and high as the one before (a side of one pixel stays)
/// down to a single pixel. Neighbours in a row are averaged first, then the two rows, each time rounded up:
/// what llvmpipe's glGenerateMipmap (Mesa 22.3.6) does, to the bit, but for 0.1 s of compiling shaders; and
/// the same on every renderer, where OpenGL leaves it open. Sides must be powers of two.
std::vector<TextureLevel> smaller_copies(int width_px, int height_px, const std::uint8_t* rgb);

}  // namespace understory
