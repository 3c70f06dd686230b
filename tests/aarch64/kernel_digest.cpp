// Runs the detector's kernel over made-up pairs, compares it with the plain rule, rectification with a plain
// loop, and prints a digest of all matches: the same number on every processor. Exit status 1 where they
// differ.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include "perception/pushbroom/pushbroom_kernel.hpp"
#include "perception/rectification/byte_remap.hpp"
#include "tests/support/plain_pushbroom.hpp"

using namespace understory;

namespace {

constexpr int width_px = 376, height_px = 240, disparity_px = 33;

std::vector<std::uint8_t> left_image(std::mt19937_64& generator, bool saturated) {
  std::vector<std::uint8_t> image(width_px * height_px);
  for (std::uint8_t& pixel : image) {
    const auto bits = static_cast<std::uint8_t>(generator() >> 56);
    pixel = saturated ? (bits & 1 ? 255 : 0) : bits;
  }
  return image;
}

// The left image moved by the disparity in every other band of twenty rows, with a little noise.
std::vector<std::uint8_t> right_image(const std::vector<std::uint8_t>& left, std::mt19937_64& generator) {
  std::vector<std::uint8_t> image(left.size());
  for (int v = 0; v < height_px; ++v)
    for (int u = 0; u < width_px; ++u) {
      const int from = std::min(u + (v / 20 % 2 == 0 ? disparity_px : 0), width_px - 1);
      const int value =
          left[static_cast<std::size_t>(v * width_px + from)] + static_cast<int>(generator() % 9) - 4;
      image[static_cast<std::size_t>(v * width_px + u)] =
          static_cast<std::uint8_t>(std::clamp(value, 0, 255));
    }
  return image;
}

// Of each pixel: its column and row in a picture that is turned a little and bent, its corners cut off.
std::vector<std::int16_t> bent_places() {
  std::vector<std::int16_t> places;
  for (int v = 0; v < height_px; ++v)
    for (int u = 0; u < width_px; ++u) {
      places.push_back(static_cast<std::int16_t>(u + (v - 120) / 16 + (u - 188) * (u - 188) / 4096 - 4));
      places.push_back(static_cast<std::int16_t>(v - (u - 188) / 16 + (u - 188) * (v - 120) / 2048));
    }
  return places;
}

bool remaps_rightly(const std::vector<std::uint8_t>& image) {
  const std::vector<std::int16_t> places = bent_places();
  ByteRemap remap(places, width_px, height_px, 0, width_px);
  remap.prepare(width_px);
  std::vector<std::uint8_t> output(image.size());
  remap.apply({image.data(), width_px, width_px, height_px}, 0, height_px, output.data(), width_px);
  for (std::size_t i = 0; i < output.size(); ++i) {
    const int u = places[2 * i], v = places[2 * i + 1];
    const bool inside = u >= 0 && u < width_px && v >= 0 && v < height_px;
    if (output[i] != (inside ? image[static_cast<std::size_t>(v * width_px + u)] : 0)) return false;
  }
  return true;
}

BlockRule rule(int variant) {
  BlockRule rule;
  rule.width_px = width_px;
  rule.height_px = height_px;
  rule.last_row_px = 205;
  rule.disparities = {{disparity_px, 215, score_limit_units(0.25)}};
  if (variant == 3) rule.disparities.push_back({28, 215, score_limit_units(0.25)});
  rule.horizontal_invariance = variant == 0 || variant == 3;
  rule.infinity_px = 20;
  rule.window.limit_units = score_limit_units(0.324);
  rule.uniqueness = variant == 1;
  rule.minimum_disparity_px = 20;
  rule.maximum_disparity_px = 106;
  return rule;
}

}  // namespace

int main() {
  std::mt19937_64 generator(3);
  std::uint64_t digest = 14695981039346656037u;  // FNV-1a
  std::size_t count = 0;
  for (int pair = 0; pair < 6; ++pair) {
    const std::vector<std::uint8_t> left = left_image(generator, pair % 3 == 2),
                                    right = right_image(left, generator);
    if (!remaps_rightly(left)) return std::printf("pair %d is rectified wrongly\n", pair), 1;
    const GrayView left_view{left.data(), width_px, width_px, height_px};
    const GrayView right_view{right.data(), width_px, width_px, height_px};
    for (int variant = 0; variant < 4; ++variant) {
      PushbroomKernel kernel(rule(variant));
      const auto& found = kernel.search(left_view, right_view, 0, kernel.strip_count());
      const auto expected = support::plain_matches(rule(variant), left_view, right_view);
      bool equal = found.size() == expected.size();
      for (std::size_t i = 0; equal && i < found.size(); ++i) {
        const int a[] = {found[i].column_px, found[i].row_px,        found[i].disparity,
                         found[i].sad,       found[i].left_edge_sum, found[i].right_edge_sum};
        const int b[] = {expected[i].column_px, expected[i].row_px,        expected[i].disparity,
                         expected[i].sad,       expected[i].left_edge_sum, expected[i].right_edge_sum};
        for (int k = 0; k < 6; ++k) {
          equal = equal && a[k] == b[k];
          digest = (digest ^ static_cast<std::uint64_t>(a[k])) * 1099511628211u;
        }
      }
      if (!equal) return std::printf("pair %d, variant %d: kernel and plain rule differ\n", pair, variant), 1;
      count += found.size();
    }
  }
  std::printf("%zu matches, digest %016llx\n", count, static_cast<unsigned long long>(digest));
  return count > 1000 ? 0 : 1;
}
