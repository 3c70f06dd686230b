#include "sim/scene/textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
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

// The loops over pixels, also for processors with wider registers: chosen when the program starts, the same
// to the bit (no multiplication is fused with an addition).
#ifdef __x86_64__
#define FOR_WIDER_REGISTERS __attribute__((target_clones("avx2", "default")))
#else
#define FOR_WIDER_REGISTERS
#endif

FOR_WIDER_REGISTERS
void mix_all(const double* a, const double* b, const double* t, std::size_t count, double* mixed) {
  for (std::size_t i = 0; i < count; ++i) mixed[i] = mix(a[i], b[i], t[i]);
}

FOR_WIDER_REGISTERS
void add_mixed(const double* a, const double* b, double t, std::size_t count, double* sum) {
  for (std::size_t i = 0; i < count; ++i) sum[i] += mix(a[i], b[i], t);
}

FOR_WIDER_REGISTERS
void add_fissured(const double* a, const double* b, double t, std::size_t count, double* sum) {
  for (std::size_t i = 0; i < count; ++i) {
    const double away = std::abs(mix(a[i], b[i], t)) * 3;
    sum[i] += 2 * (away < 1.0 ? away : 1.0) - 1;
  }
}

FOR_WIDER_REGISTERS
void shade(const double* noise, std::size_t count, double mean, double gain, double offset,
           std::uint8_t* gray) {
  for (std::size_t i = 0; i < count; ++i) {
    const double level = offset + gain * (noise[i] - mean);
    gray[i] = static_cast<std::uint8_t>(std::min(std::max(level, 0.0), 255.0) + 0.5);
  }
}

/// For every pixel along one side of a lattice that wraps: the nodes on both sides of its middle, and the
/// farther one's weight.
struct Betweens {
  std::vector<std::size_t> before, after;
  std::vector<double> weight;
};

Betweens betweens(int cells, int pixels) {
  Betweens all;
  for (int pixel = 0; pixel < pixels; ++pixel) {
    const double at = (pixel + 0.5) / pixels * cells;
    const int before = static_cast<int>(at);
    const double t = at - before;
    all.before.push_back(static_cast<std::size_t>(before % cells));
    all.after.push_back(static_cast<std::size_t>((before + 1) % cells));
    all.weight.push_back(t * t * (3 - 2 * t));
  }
  return all;
}

/// One octave: random values on a wrapping lattice, interpolated with a smooth weight. It is evaluated row by
/// row, and values common to all pixels between two rows of nodes are computed once, because every flight
/// paints its ground.
class Octave {
 public:
  Octave(int columns, int rows, int width_px, int height_px, std::mt19937_64& generator)
      : columns_(static_cast<std::size_t>(columns)),
        across_(betweens(columns, width_px)),
        down_(betweens(rows, height_px)) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    nodes_.resize(columns_ * static_cast<std::size_t>(rows));
    for (double& node : nodes_) node = uniform(generator);
  }

  /// Adds this row's values to a row of `sum`; fissures are where they cross zero.
  void add_row(int row_px, bool fissured, double* sum) {
    const auto row = static_cast<std::size_t>(row_px);
    if (down_.before[row] == below_.row) std::swap(above_, below_);
    spread(down_.before[row], above_);
    spread(down_.after[row], below_);
    const auto add = fissured ? add_fissured : add_mixed;
    add(above_.values.data(), below_.values.data(), down_.weight[row], above_.values.size(), sum);
  }

 private:
  /// A row of nodes read at every pixel's column.
  struct SpreadRow {
    std::size_t row = SIZE_MAX;
    std::vector<double> values;
  };

  void spread(std::size_t row, SpreadRow& spread) {
    if (row == spread.row) return;
    const std::size_t count = across_.weight.size();
    spread.row = row;
    spread.values.resize(count), before_.resize(count), after_.resize(count);
    const double* nodes = nodes_.data() + row * columns_;
    for (std::size_t i = 0; i < count; ++i) before_[i] = nodes[across_.before[i]];
    for (std::size_t i = 0; i < count; ++i) after_[i] = nodes[across_.after[i]];
    mix_all(before_.data(), after_.data(), across_.weight.data(), count, spread.values.data());
  }

  std::size_t columns_;
  Betweens across_, down_;
  std::vector<double> nodes_, before_, after_;
  SpreadRow above_, below_;
};

/// The octaves of a texture, from the coarsest on. Their nodes are drawn in this order.
std::vector<Octave> octaves_of(const TextureRequest& request, std::mt19937_64& generator) {
  std::vector<Octave> octaves;
  for (int octave = 0; octave < request.octaves; ++octave) {
    const int columns = request.coarsest_cells << octave;
    const double cell_height_px = request.elongation * request.width_px / columns;
    const int rows = std::max(1, static_cast<int>(std::lround(request.height_px / cell_height_px)));
    octaves.emplace_back(columns, rows, request.width_px, request.height_px, generator);
  }
  return octaves;
}

/// The sum of the octaves at every pixel. Row by row through all of them, so that sums stay in the cache.
std::vector<double> noise_of(const TextureRequest& request) {
  std::mt19937_64 generator(request.seed);
  std::vector<Octave> octaves = octaves_of(request, generator);
  std::vector<double> noise(static_cast<std::size_t>(request.width_px) * request.height_px, 0.0);
  for (int row = 0; row < request.height_px; ++row) {
    double* const sum = noise.data() + static_cast<std::size_t>(row) * request.width_px;
    for (std::size_t octave = 0; octave < octaves.size(); ++octave) {
      const bool fissured = request.fissures && octave >= 1 && octave <= 3;
      octaves[octave].add_row(row, fissured, sum);
    }
  }
  return noise;
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
  // Four histograms, because equal neighbours would otherwise wait for the same counter.
  std::array<std::array<std::int64_t, 256>, 4> tallies{};
  for (std::size_t i = 0; i < gray.size(); ++i) ++tallies[i % 4][gray[i]];
  std::array<std::int64_t, 256> counts{};
  for (std::size_t value = 0; value < counts.size(); ++value)
    for (const auto& tally : tallies) counts[value] += tally[value];
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

GrayTexture make_texture(const TextureRequest& request) {
  GrayTexture texture{request.width_px, request.height_px, {}};
  const std::vector<double> noise = noise_of(request);

  // Clipping at black and white reduces the contrast. Increase it until the clipped result has the requested
  // contrast.
  const Moments raw = moments(noise);
  double gain = request.contrast * request.mean_gray / raw.deviation, offset = request.mean_gray;
  texture.gray.resize(noise.size());
  shade(noise.data(), noise.size(), raw.mean, gain, offset, texture.gray.data());
  for (int pass = 0; pass < 3; ++pass) {
    const Moments got = moments(texture.gray);
    if (got.deviation > 0) gain *= request.contrast * request.mean_gray / got.deviation;
    offset += request.mean_gray - got.mean;
    shade(noise.data(), noise.size(), raw.mean, gain, offset, texture.gray.data());
  }
  return texture;
}

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
