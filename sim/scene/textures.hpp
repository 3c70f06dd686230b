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

}  // namespace understory
