#include "sim/scene/texture_levels.hpp"

#include <algorithm>
#include <cstddef>

namespace understory {
namespace {

constexpr int channels = 3;

std::uint8_t average(int a, int b) { return static_cast<std::uint8_t>((a + b + 1) / 2); }

TextureLevel half_of(int width_px, int height_px, const std::uint8_t* rgb) {
  TextureLevel half{std::max(1, width_px / 2), std::max(1, height_px / 2), {}};
  half.rgb.resize(static_cast<std::size_t>(channels) * half.width_px * half.height_px);
  const std::ptrdiff_t right = width_px > 1 ? channels : 0, row = std::ptrdiff_t{channels} * width_px;
  const std::ptrdiff_t below = height_px > 1 ? row : 0;
  std::uint8_t* to = half.rgb.data();
  for (int y = 0; y < half.height_px; ++y) {
    const std::uint8_t* from = rgb + y * (row + below);
    for (int x = 0; x < half.width_px; ++x, from += channels + right)
      for (int channel = 0; channel < channels; ++channel, ++to) {
        const std::uint8_t* at = from + channel;
        *to = average(average(at[0], at[right]), average(at[below], at[below + right]));
      }
  }
  return half;
}

}  // namespace

std::vector<TextureLevel> smaller_copies(int width_px, int height_px, const std::uint8_t* rgb) {
  std::vector<TextureLevel> copies;
  while (width_px > 1 || height_px > 1) {
    copies.push_back(half_of(width_px, height_px, rgb));
    width_px = copies.back().width_px;
    height_px = copies.back().height_px;
    rgb = copies.back().rgb.data();
  }
  return copies;
}

}  // namespace understory
