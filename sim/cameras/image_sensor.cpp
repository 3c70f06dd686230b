#include "sim/cameras/image_sensor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

namespace understory {
namespace {

constexpr std::size_t table_size = std::size_t{1} << 19;

/// std::generate_canonical<double, 53> to the bit: the compiler's conversion of 64 bits without sign branches
/// on the highest, which is a coin.
double drawn(std::mt19937_64& generator) {
  const std::uint64_t bits = generator();
  const auto high = static_cast<double>(static_cast<std::int64_t>(bits >> 32));
  const auto low = static_cast<double>(static_cast<std::int64_t>(bits & 0xffffffffu));
  const double value = (high * 0x1p32 + low) * 0x1p-64;
  return value < 1.0 ? value : std::nextafter(1.0, 0.0);
}

/// The factor of Marsaglia's polar method for a point of the unit disc, from its squared distance.
double stretch(double square) { return std::sqrt(-2 * std::log(square) / square); }

/// Bounds of stretch() between two steps of the squared distance, a little wide for its rounding.
struct StretchBounds {
  double minimum, maximum;
};
constexpr int bound_count = 1024;

std::array<StretchBounds, bound_count> stretch_bounds() {
  std::array<StretchBounds, bound_count> bounds;
  const auto at = [](int step) { return stretch(static_cast<double>(step) / bound_count); };  // it falls
  for (int i = 0; i < bound_count; ++i)
    bounds[static_cast<std::size_t>(i)] = {at(i + 1) * (1 - 1e-12), at(std::max(i, 1)) * (1 + 1e-12)};
  bounds[0].maximum = 1e100;  // without bound, but times zero still zero
  return bounds;
}

}  // namespace

ImageNoise::ImageNoise(double deviation_gray, std::uint64_t seed)
    : silent_(deviation_gray <= 0), generator_(seed) {
  if (silent_) return;
  table_ = rounded_gaussians(table_size, deviation_gray, generator_);
}

void ImageNoise::add_to(cv::Mat& gray, float gain) {
  if (silent_) return;
  const int columns =
      gray.cols;  // a local copy: bytes could alias a member, and the loop would not become SIMD
  for (int row = 0; row < gray.rows; ++row) {
    const std::int8_t* noise =
        table_.data() + generator_() % (table_size - static_cast<std::size_t>(columns));
    std::uint8_t* pixel = gray.ptr<std::uint8_t>(row);
    if (gain != 1) {
      for (int column = 0; column < columns; ++column)
        pixel[column] = cv::saturate_cast<std::uint8_t>(static_cast<float>(pixel[column]) +
                                                        gain * static_cast<float>(noise[column]));
      continue;
    }
    for (int column = 0; column < columns; ++column) {
      const std::int16_t sum = static_cast<std::int16_t>(pixel[column] + noise[column]);
      pixel[column] = static_cast<std::uint8_t>(std::min<std::int16_t>(std::max<std::int16_t>(sum, 0), 255));
    }
  }
}

PixelResponse::PixelResponse(const CameraConfig& config, std::array<cv::Mat, 2> falloff, std::uint64_t seed)
    : neutral_(config.light == 1 && config.gain == 1 && config.full_well_e <= 0 && falloff[0].empty()),
      light_(static_cast<float>(config.light)),
      gain_(static_cast<float>(config.gain)),
      variance_per_gray_(config.full_well_e > 0 ? static_cast<float>(255 / config.full_well_e) : 0),
      falloff_(std::move(falloff)),
      generator_(seed) {
  if (config.full_well_e <= 0) return;
  std::normal_distribution<float> standard;
  normal_.resize(table_size);
  for (float& value : normal_) value = standard(generator_);
}

void PixelResponse::apply(int eye, cv::Mat& gray, float automatic) {
  if (neutral_ && automatic == 1) return;
  const cv::Mat& falloff = falloff_[static_cast<std::size_t>(eye)];
  // Local copies: bytes could alias a member, and the loops would not become SIMD.
  const int columns = gray.cols;
  const float light = light_ * std::min(automatic, 1.0f), gain = gain_ * std::max(automatic, 1.0f),
              variance_per_gray = variance_per_gray_;
  std::vector<float> seen(static_cast<std::size_t>(columns));
  const std::vector<float> no_lens(falloff.empty() ? static_cast<std::size_t>(columns) : 0, 1.0f);
  for (int row = 0; row < gray.rows; ++row) {
    std::uint8_t* pixel = gray.ptr<std::uint8_t>(row);
    const float* lens = falloff.empty() ? no_lens.data() : falloff.ptr<float>(row);
    float* value = seen.data();
    for (int i = 0; i < columns; ++i)
      value[i] = std::min(light * lens[i] * static_cast<float>(pixel[i]), 255.0f);
    if (!normal_.empty()) {
      const float* draw = normal_.data() + generator_() % (table_size - static_cast<std::size_t>(columns));
      for (int i = 0; i < columns; ++i) value[i] += std::sqrt(variance_per_gray * value[i]) * draw[i];
    }
    for (int i = 0; i < columns; ++i) {
      const float read = gain * value[i] + 0.5f;
      pixel[i] = static_cast<std::uint8_t>(static_cast<int>(std::min(std::max(read, 0.0f), 255.0f)));
    }
  }
}

void AutoExposure::observe(const cv::Mat& gray, std::int64_t t_ns) {
  constexpr double most = 64;
  if (lag_s_ <= 0) return;
  const double passed_s = before_ns_ < 0 ? 0 : 1e-9 * static_cast<double>(t_ns - before_ns_);
  before_ns_ = t_ns;
  const double wanted = target_gray_ / std::max(1.0, cv::mean(gray)[0]);
  factor_ = std::clamp(factor_ * std::pow(wanted, 1 - std::exp(-passed_s / lag_s_)), 1 / most, most);
}

std::vector<std::int8_t> rounded_gaussians(std::size_t count, double deviation, std::mt19937_64& generator) {
  const auto bounds = stretch_bounds();
  const auto exact = [deviation](double value) {
    return static_cast<std::int8_t>(std::clamp(std::lround(value * deviation), -127L, 127L));
  };
  const auto size_at = [deviation](double coordinate, double stretched) {
    return static_cast<int>(std::min(std::abs(coordinate) * stretched * deviation, 127.0) + 0.5);
  };
  std::vector<std::int8_t> values(count);
  for (std::size_t i = 0; i + 1 < count; i += 2) {
    double x, y, square;
    do {
      x = 2.0 * drawn(generator) - 1.0;
      y = 2.0 * drawn(generator) - 1.0;
      square = x * x + y * y;
    } while (square > 1.0 || square == 0.0);
    // Where both bounds round to the same value, so does everything between them. Most logarithms are then
    // unnecessary.
    const auto step = static_cast<std::size_t>(std::min(square * bound_count, bound_count - 1.0));
    const int size_x = size_at(x, bounds[step].minimum), size_y = size_at(y, bounds[step].minimum);
    if (size_x == size_at(x, bounds[step].maximum) && size_y == size_at(y, bounds[step].maximum)) {
      values[i] = static_cast<std::int8_t>(y < 0 ? -size_y : size_y);
      values[i + 1] = static_cast<std::int8_t>(x < 0 ? -size_x : size_x);
    } else {
      values[i] = exact(y * stretch(square));
      values[i + 1] = exact(x * stretch(square));
    }
  }
  return values;
}

}  // namespace understory
