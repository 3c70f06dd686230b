#include "sim/scene/textures.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "sim/render/offscreen_context.hpp"

namespace understory {
namespace {

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
