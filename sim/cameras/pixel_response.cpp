#include "sim/cameras/pixel_response.hpp"

#include <algorithm>
#include <cmath>

namespace understory {
namespace {
constexpr std::size_t table_size = std::size_t{1} << 19;
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

void PixelResponse::apply(int eye, cv::Mat& gray) {
  if (neutral_) return;
  const cv::Mat& falloff = falloff_[static_cast<std::size_t>(eye)];
  const int columns = gray.cols;
  std::vector<float> seen(static_cast<std::size_t>(columns));
  for (int row = 0; row < gray.rows; ++row) {
    std::uint8_t* pixel = gray.ptr<std::uint8_t>(row);
    const float* lens = falloff.empty() ? nullptr : falloff.ptr<float>(row);
    for (int i = 0; i < columns; ++i)
      seen[static_cast<std::size_t>(i)] =
          std::min(light_ * (lens != nullptr ? lens[i] : 1.0f) * static_cast<float>(pixel[i]), 255.0f);
    if (!normal_.empty()) {
      const float* draw = normal_.data() + generator_() % (table_size - static_cast<std::size_t>(columns));
      for (float& value : seen) value += std::sqrt(variance_per_gray_ * value) * *draw++;
    }
    for (int i = 0; i < columns; ++i) {
      const float read = gain_ * seen[static_cast<std::size_t>(i)] + 0.5f;
      pixel[i] = static_cast<std::uint8_t>(std::min(std::max(read, 0.0f), 255.0f));
    }
  }
}

}  // namespace understory
