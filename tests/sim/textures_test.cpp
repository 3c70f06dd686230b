#include "sim/textures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace understory {
namespace {

struct Statistic {
  double mean, contrast;
};

Statistic statistic(const GrayTexture& texture) {
  double sum = 0, squares = 0;
  for (const double gray : texture.gray) sum += gray, squares += gray * gray;
  const double count = static_cast<double>(texture.gray.size()), mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean) / mean};
}

/// Averages square blocks, as a pixel far away does.
GrayTexture seen_from_afar(const GrayTexture& texture, int block) {
  GrayTexture coarse{texture.width_px / block, texture.height_px / block, {}};
  for (int row = 0; row < coarse.height_px; ++row)
    for (int column = 0; column < coarse.width_px; ++column) {
      int sum = 0;
      for (int y = 0; y < block; ++y)
        for (int x = 0; x < block; ++x)
          sum +=
              texture.gray[static_cast<std::size_t>(row * block + y) * texture.width_px + column * block + x];
      coarse.gray.push_back(static_cast<std::uint8_t>(sum / (block * block)));
    }
  return coarse;
}

TextureRequest bark(double contrast, std::uint64_t seed = 1) {
  return {.width_px = 256,
          .height_px = 512,
          .mean_gray = 132,
          .contrast = contrast,
          .coarsest_cells = 1,
          .octaves = 7,
          .elongation = 2.5,
          .fissures = true,
          .seed = seed};
}

TEST(Textures, ContrastAndMeanAreWhatWasAsked) {
  for (const double contrast : {0.1, 0.2, 0.35, 0.5})
    for (const std::uint64_t seed : {1u, 2u, 77u}) {
      const Statistic got = statistic(make_texture(bark(contrast, seed)));
      EXPECT_NEAR(got.contrast, contrast, 0.02 * contrast) << seed;
      EXPECT_NEAR(got.mean, 132, 2) << seed;
    }
  EXPECT_NEAR(statistic(make_texture(bark(0))).contrast, 0, 1e-9);
}

TEST(Textures, HaveDetailAtEveryDistance) {
  const GrayTexture texture = make_texture(bark(0.35));  // 3.1 mm a texel
  for (const int block : {2, 4, 8})                      // pixels of 6 to 25 mm on the bark
    EXPECT_GT(statistic(seen_from_afar(texture, block)).contrast, 0.35 * 0.5) << block;
}

TEST(Textures, Tile) {
  const GrayTexture texture = make_texture(bark(0.35));
  const auto at = [&](int row, int column) {
    return static_cast<int>(texture.gray[static_cast<std::size_t>(row) * texture.width_px + column]);
  };
  double across_seam = 0, inside = 0;
  for (int row = 0; row < texture.height_px; ++row) {
    across_seam += std::abs(at(row, 0) - at(row, texture.width_px - 1));
    inside += std::abs(at(row, 100) - at(row, 101));
  }
  EXPECT_LT(across_seam, 1.5 * inside);
  across_seam = inside = 0;
  for (int column = 0; column < texture.width_px; ++column) {
    across_seam += std::abs(at(0, column) - at(texture.height_px - 1, column));
    inside += std::abs(at(200, column) - at(201, column));
  }
  EXPECT_LT(across_seam, 2.0 * inside);
}

TEST(Textures, FollowTheirSeed) {
  EXPECT_EQ(make_texture(bark(0.3, 5)).gray, make_texture(bark(0.3, 5)).gray);
  EXPECT_NE(make_texture(bark(0.3, 5)).gray, make_texture(bark(0.3, 6)).gray);
}

}  // namespace
}  // namespace understory
