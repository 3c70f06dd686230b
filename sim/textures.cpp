#include "sim/textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

namespace understory {
namespace {

/// std::lerp to the bit for finite values and 0 <= t < 1, without its branches, so that loops become SIMD.
inline double mix(double a, double b, double t) {
  const double across_zero = t * b + (1 - t) * a;
  const double along = a + t * (b - a);
  const double capped = b > a ? (b > along ? along : b) : (b < along ? along : b);
  return a * b <= 0 ? across_zero : capped;
}

/// The nodes on both sides of a pixel's middle, along one side of a lattice that wraps, and the farther one's
/// weight.
struct Between {
  int before, after;
  double weight;
};

std::vector<Between> betweens(int cells, int pixels) {
  std::vector<Between> all;
  for (int pixel = 0; pixel < pixels; ++pixel) {
    const double at = (pixel + 0.5) / pixels * cells;
    const int before = static_cast<int>(at);
    const double t = at - before;
    all.push_back({before % cells, (before + 1) % cells, t * t * (3 - 2 * t)});
  }
  return all;
}

/// Random values on a lattice that wraps, read between its nodes with a smooth weight: one octave. It is read
/// row by row, and what is the same for all pixels between two rows of nodes is reckoned once: every flight
/// paints its ground.
class Octave {
 public:
  Octave(int columns, int rows, int width_px, int height_px, std::mt19937_64& generator)
      : columns_(columns), across_(betweens(columns, width_px)), down_(betweens(rows, height_px)) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    nodes_.resize(static_cast<std::size_t>(columns) * rows);
    for (double& node : nodes_) node = uniform(generator);
  }

  /// Of every pixel of this row; valid until the next call.
  const std::vector<double>& row(int row_px) {
    const Between& here = down_[static_cast<std::size_t>(row_px)];
    if (here.before == below_row_) std::swap(above_, below_), std::swap(above_row_, below_row_);
    spread(here.before, above_row_, above_);
    spread(here.after, below_row_, below_);
    values_.resize(across_.size());
    const double *above = above_.data(), *below = below_.data(), weight = here.weight;
    double* values = values_.data();
    const std::size_t count = values_.size();
    for (std::size_t i = 0; i < count; ++i) values[i] = mix(above[i], below[i], weight);
    return values_;
  }

 private:
  /// A row of nodes read at every pixel's column.
  void spread(int row, int& spread_row, std::vector<double>& values) const {
    if (row == spread_row) return;
    spread_row = row;
    values.resize(across_.size());
    const double* nodes = nodes_.data() + static_cast<std::size_t>(row) * columns_;
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = mix(nodes[across_[i].before], nodes[across_[i].after], across_[i].weight);
  }

  int columns_;
  std::vector<Between> across_, down_;
  std::vector<double> nodes_, above_, below_, values_;
  int above_row_ = -1, below_row_ = -1;  ///< of the nodes that above_ and below_ hold
};

void add_octave(const TextureRequest& request, int octave, std::mt19937_64& generator,
                std::vector<double>& sum) {
  const int columns = request.coarsest_cells << octave;
  const double cell_height_px = request.elongation * request.width_px / columns;
  const int rows = std::max(1, static_cast<int>(std::lround(request.height_px / cell_height_px)));
  Octave noise(columns, rows, request.width_px, request.height_px, generator);
  const bool fissured = request.fissures && octave >= 1 && octave <= 3;
  double* target = sum.data();
  for (int row = 0; row < request.height_px; ++row)
    for (const double value : noise.row(row))
      *target++ += fissured ? 2 * std::min(std::abs(value) * 3, 1.0) - 1 : value;
}

struct Moments {
  double mean, deviation;
};

Moments moments(const std::vector<double>& values) {
  double sum = 0, square_sum = 0;
  for (const double value : values) sum += value;
  const double mean = sum / static_cast<double>(values.size());
  for (const double value : values) square_sum += (value - mean) * (value - mean);
  return {mean, std::sqrt(square_sum / static_cast<double>(values.size()))};
}

Moments moments(const std::vector<std::uint8_t>& gray) {
  std::array<std::int64_t, 256> counts{};
  for (const std::uint8_t value : gray) ++counts[value];
  const auto count = static_cast<double>(gray.size());
  double sum = 0, square_sum = 0;
  for (std::size_t value = 0; value < counts.size(); ++value)
    sum += static_cast<double>(counts[value]) * static_cast<double>(value);
  const double mean = sum / count;
  for (std::size_t value = 0; value < counts.size(); ++value) {
    const double away = static_cast<double>(value) - mean;
    square_sum += static_cast<double>(counts[value]) * away * away;
  }
  return {mean, std::sqrt(square_sum / count)};
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
    for (std::size_t i = 0; i < noise.size(); ++i) {
      const double gray = offset + gain * (noise[i] - raw.mean);
      texture.gray[i] = static_cast<std::uint8_t>(std::min(std::max(gray, 0.0), 255.0) + 0.5);
    }
    const Moments got = moments(texture.gray);
    if (got.deviation > 0) gain *= request.contrast * request.mean_gray / got.deviation;
    offset += request.mean_gray - got.mean;
  }
  return texture;
}

}  // namespace understory
