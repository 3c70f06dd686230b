#pragma once

#include <cstdint>
#include <vector>

namespace understory {

/// A gray picture that tiles: its right edge meets its left, its bottom its top. Rows from the top, 8 bits.
struct GrayTexture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> gray;
};

/// Parameters of a procedural texture. `contrast` is the standard deviation over the mean of its gray levels.
struct TextureRequest {
  int width_px = 0;
  int height_px = 0;
  double mean_gray = 128;
  double contrast = 0.3;
  int coarsest_cells = 1;  ///< cells of the coarsest octave across the width
  int octaves = 6;  ///< each octave halves the cell; all carry the same energy (1/f amplitude per wavelength)
  double elongation = 1;  ///< cells are this much taller than wide, in pixels
  bool fissures = false;  ///< dark cracks where the coarser octaves cross zero, as bark has them
  std::uint64_t seed = 1;
};

/// Sum of octaves of value noise, scaled to the requested mean and contrast. Equal parameters give equal
/// textures.
GrayTexture make_texture(const TextureRequest& request);

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
