#include "sim/textures.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace understory {
namespace {

/// Random values on a lattice that wraps, read between its nodes with a smooth weight: one octave.
class Octave {
 public:
  Octave(int columns, int rows, std::mt19937_64& generator) : columns_(columns), rows_(rows) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    nodes_.resize(static_cast<std::size_t>(columns) * rows);
    for (double& node : nodes_) node = uniform(generator);
  }

  /// `x` and `y` in 0 .. 1 across the tile.
  double at(double x, double y) const {
    const double column = x * columns_, row = y * rows_;
    const int left = static_cast<int>(column), top = static_cast<int>(row);
    const double right_weight = smooth(column - left), bottom_weight = smooth(row - top);
    const double above = std::lerp(node(left, top), node(left + 1, top), right_weight);
    const double below = std::lerp(node(left, top + 1), node(left + 1, top + 1), right_weight);
    return std::lerp(above, below, bottom_weight);
  }

 private:
  static double smooth(double t) { return t * t * (3 - 2 * t); }
  double node(int column, int row) const {
    return nodes_[static_cast<std::size_t>(row % rows_) * columns_ + column % columns_];
  }

  int columns_, rows_;
  std::vector<double> nodes_;
};

void add_octave(const TextureRequest& request, int octave, std::mt19937_64& generator,
                std::vector<double>& sum) {
  const int columns = request.coarsest_cells << octave;
  const double cell_height_px = request.elongation * request.width_px / columns;
  const int rows = std::max(1, static_cast<int>(std::lround(request.height_px / cell_height_px)));
  const Octave noise(columns, rows, generator);
  const bool fissured = request.fissures && octave >= 1 && octave <= 3;
  std::size_t pixel = 0;
  for (int row = 0; row < request.height_px; ++row)
    for (int column = 0; column < request.width_px; ++column, ++pixel) {
      const double value = noise.at((column + 0.5) / request.width_px, (row + 0.5) / request.height_px);
      sum[pixel] += fissured ? 2 * std::min(std::abs(value) * 3, 1.0) - 1 : value;
    }
}

struct Moments {
  double mean, deviation;
};

template <typename Values>
Moments moments(const Values& values) {
  double sum = 0, square_sum = 0;
  for (const double value : values) sum += value;
  const double mean = sum / static_cast<double>(values.size());
  for (const double value : values) square_sum += (value - mean) * (value - mean);
  return {mean, std::sqrt(square_sum / static_cast<double>(values.size()))};
}

}  // namespace

GrayTexture make_texture(const TextureRequest& request) {
  std::mt19937_64 generator(request.seed);
  GrayTexture texture{request.width_px, request.height_px, {}};
  std::vector<double> noise(static_cast<std::size_t>(request.width_px) * request.height_px, 0.0);
  for (int octave = 0; octave < request.octaves; ++octave) add_octave(request, octave, generator, noise);

  // Clipping at black and white takes from the spread: ask for a little more until what is left is what was
  // wanted.
  const Moments raw = moments(noise);
  double gain = request.contrast * request.mean_gray / raw.deviation, offset = request.mean_gray;
  texture.gray.resize(noise.size());
  for (int pass = 0; pass < 4; ++pass) {
    for (std::size_t i = 0; i < noise.size(); ++i)
      texture.gray[i] =
          static_cast<std::uint8_t>(std::clamp(std::lround(offset + gain * (noise[i] - raw.mean)), 0L, 255L));
    const Moments got = moments(texture.gray);
    if (got.deviation > 0) gain *= request.contrast * request.mean_gray / got.deviation;
    offset += request.mean_gray - got.mean;
  }
  return texture;
}

}  // namespace understory
