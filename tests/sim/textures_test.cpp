#include "sim/scene/textures.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "sim/render/offscreen_context.hpp"

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

/// The noise of make_texture written plainly: a double at every pixel, one octave after the other.
std::vector<double> plain_noise(const TextureRequest& request) {
  std::mt19937_64 generator(request.seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const int width = request.width_px, height = request.height_px;
  std::vector<double> noise(static_cast<std::size_t>(width * height));
  for (int octave = 0; octave < request.octaves; ++octave) {
    const int columns = request.coarsest_cells << octave;
    const int rows = std::max(
        1, static_cast<int>(std::lround(request.height_px / (request.elongation * width / columns))));
    std::vector<double> nodes(static_cast<std::size_t>(columns * rows));
    for (double& node : nodes) node = uniform(generator);
    const auto node = [&](int row, int column) {
      return nodes[static_cast<std::size_t>(row % rows * columns + column % columns)];
    };
    const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double across = (x + 0.5) / width * columns, down = (y + 0.5) / height * rows;
        const int left = static_cast<int>(across), above = static_cast<int>(down);
        const double s = smooth(across - left), t = smooth(down - above);
        const double value = std::lerp(std::lerp(node(above, left), node(above, left + 1), s),
                                       std::lerp(node(above + 1, left), node(above + 1, left + 1), s), t);
        const bool fissured = request.fissures && octave >= 1 && octave <= 3;
        noise[static_cast<std::size_t>(y * width + x)] +=
            fissured ? 2 * std::min(std::abs(value) * 3, 1.0) - 1 : value;
      }
  }
  return noise;
}

TEST(Textures, AreThePlainNoiseRescaled) {
  for (const bool fissures : {false, true}) {
    TextureRequest request{.width_px = 96,
                           .height_px = 128,
                           .contrast = 0.05,
                           .coarsest_cells = 3,
                           .octaves = 5,
                           .elongation = 1.5,
                           .fissures = fissures,
                           .seed = 5};
    const std::vector<double> noise = plain_noise(request);
    const std::vector<std::uint8_t> gray = make_texture(request).gray;
    const double count = static_cast<double>(noise.size());
    double mean = 0, square = 0;
    for (const double value : noise) mean += value / count;
    for (const double value : noise) square += (value - mean) * (value - mean) / count;
    const double gain = 0.05 * request.mean_gray / std::sqrt(square);  // nothing is clipped at this contrast
    for (std::size_t i = 0; i < noise.size(); ++i)
      ASSERT_NEAR(gray[i], request.mean_gray + gain * (noise[i] - mean), 0.56) << i;  // rounded
  }
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

std::vector<std::uint8_t> random_texture(int width_px, int height_px, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::vector<std::uint8_t> rgb(std::size_t{3} * width_px * height_px);
  for (std::uint8_t& value : rgb) value = static_cast<std::uint8_t>(generator());
  return rgb;
}

TEST(TextureLevels, HalveDownToOnePixel) {
  const std::vector<TextureLevel> copies = smaller_copies(8, 2, random_texture(8, 2, 1).data());
  ASSERT_EQ(copies.size(), 3u);
  const int expected[3][2] = {{4, 1}, {2, 1}, {1, 1}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(copies[i].width_px, expected[i][0]);
    EXPECT_EQ(copies[i].height_px, expected[i][1]);
    EXPECT_EQ(copies[i].rgb.size(), std::size_t{3} * expected[i][0] * expected[i][1]);
  }
  const std::uint8_t pixel[3] = {1, 2, 3};
  EXPECT_TRUE(smaller_copies(1, 1, pixel).empty());
}

TEST(TextureLevels, AverageRowsThenColumnsRoundedUp) {
  // Red (0, 1 / 0, 0): 1 in the first row, 0 in the second, 1 of the two. Green as flat as it was.
  const std::uint8_t rgb[12] = {0, 7, 0, 1, 7, 255, 0, 7, 0, 0, 7, 255};
  const std::vector<TextureLevel> copies = smaller_copies(2, 2, rgb);
  ASSERT_EQ(copies.size(), 1u);
  EXPECT_EQ(copies[0].rgb, (std::vector<std::uint8_t>{1, 7, 128}));
}

// llvmpipe's own levels, read back from it.
TEST(TextureLevels, AreThoseThatLlvmpipeMakes) {
  OffscreenContext context;
  context.make_current(16, 16);
  if (context.renderer().find("llvmpipe") == std::string::npos) GTEST_SKIP() << context.renderer();
  const auto function = [](const char* name) {
    using GetProcAddress = void* (*)(const char* name);
    return as_function<GetProcAddress>(dlsym(RTLD_DEFAULT, "OSMesaGetProcAddress"))(name);
  };
  constexpr unsigned texture_2d = 0x0DE1, rgb_format = 0x1907, bytes = 0x1401, pack_alignment = 0x0D05;
  unsigned texture = 0;
  as_function<void (*)(int, unsigned*)>(function("glGenTextures"))(1, &texture);
  as_function<void (*)(unsigned, int)>(function("glPixelStorei"))(pack_alignment, 1);
  for (const auto& [width_px, height_px] : {std::pair(256, 256), {128, 512}, {64, 1}}) {
    const std::vector<std::uint8_t> rgb = random_texture(width_px, height_px, 2);
    context.upload_level(texture, 0, width_px, height_px, rgb.data());
    as_function<void (*)(unsigned)>(function("glGenerateMipmap"))(texture_2d);
    int level = 0;
    for (const TextureLevel& copy : smaller_copies(width_px, height_px, rgb.data())) {
      std::vector<std::uint8_t> made(copy.rgb.size());
      as_function<void (*)(unsigned, int, unsigned, unsigned, void*)>(function("glGetTexImage"))(
          texture_2d, ++level, rgb_format, bytes, made.data());
      EXPECT_EQ(made, copy.rgb) << width_px << "x" << height_px << ", level " << level;
    }
  }
}

}  // namespace
}  // namespace understory
