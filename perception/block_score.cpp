#include "perception/block_score.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "perception/assertion.hpp"

namespace understory {
namespace {

std::uint8_t saturate(int response) { return static_cast<std::uint8_t>(std::clamp(response, 0, 255)); }

void edge_row(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, int width_px,
              std::uint8_t* edges) {
  // The mirrored pixel beyond an end is the one before it, so both corners of a side fall on the same column.
  edges[0] = saturate(4 * (above[1] + below[1]) - 8 * here[0]);
  for (int u = 1; u + 1 < width_px; ++u) {
    // Sixteen bits hold -2040 .. 2040; the narrow type lets the compiler take eight pixels at a time.
    const auto corners = static_cast<std::int16_t>(above[u - 1] + above[u + 1] + below[u - 1] + below[u + 1]);
    const auto response = static_cast<std::int16_t>(2 * corners - 8 * here[u]);
    const std::int16_t positive = response < 0 ? std::int16_t{0} : response;
    edges[u] = static_cast<std::uint8_t>(positive > 255 ? std::int16_t{255} : positive);
  }
  const int last = width_px - 1;
  edges[last] = saturate(4 * (above[last - 1] + below[last - 1]) - 8 * here[last]);
}

}  // namespace

std::int64_t score_limit_units(double score_limit) {
  return std::llround(score_limit * static_cast<double>(score_unit));
}

void edge_map(const GrayView& image, std::vector<std::uint8_t>& edges) {
  assert_always(image.width_px >= 2 && image.height_px >= 2, "edge_map needs an image of at least 2x2");
  edges.resize(static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px));
  const int last = image.height_px - 1;
  for (int v = 0; v <= last; ++v) {
    const std::uint8_t* above = image.row(v == 0 ? 1 : v - 1);
    const std::uint8_t* below = image.row(v == last ? last - 1 : v + 1);
    edge_row(above, image.row(v), below, image.width_px,
             edges.data() + static_cast<std::ptrdiff_t>(v) * image.width_px);
  }
}

GrayView view_of(const std::vector<std::uint8_t>& packed, int width_px, int height_px) {
  return {packed.data(), width_px, width_px, height_px};
}

int block_sum(const std::uint8_t* top_left, std::ptrdiff_t stride) {
  int sum = 0;
  for (int v = 0; v < block_px; ++v, top_left += stride)
    for (int u = 0; u < block_px; ++u) sum += top_left[u];
  return sum;
}

int block_sad(const std::uint8_t* left, std::ptrdiff_t left_stride, const std::uint8_t* right,
              std::ptrdiff_t right_stride) {
  int sad = 0;
  for (int v = 0; v < block_px; ++v, left += left_stride, right += right_stride)
    for (int u = 0; u < block_px; ++u) sad += std::abs(left[u] - right[u]);
  return sad;
}

void column_sums(const GrayView& image, int row_px, std::vector<std::uint16_t>& sums) {
  sums.resize(static_cast<std::size_t>(image.width_px));
  const std::uint8_t* rows[block_px];
  for (int v = 0; v < block_px; ++v) rows[v] = image.row(row_px + v);
  std::uint16_t* out = sums.data();
  for (int u = 0; u < image.width_px; ++u)
    out[u] = static_cast<std::uint16_t>(rows[0][u] + rows[1][u] + rows[2][u] + rows[3][u] + rows[4][u]);
}

}  // namespace understory
