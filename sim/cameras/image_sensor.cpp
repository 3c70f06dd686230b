#include "sim/cameras/image_sensor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "sim/cameras/rounded_gaussians.hpp"

namespace understory {
namespace {

constexpr std::size_t table_size = std::size_t{1} << 19;
constexpr float horizon_gray = 215;  // an overcast sky, short of saturation
constexpr float zenith_gray = 190;

/// Elevation of a pixel's ray: 0 at the horizon and below, 1 from 45 degrees up, linear in the pixel
/// coordinates.
struct SkyRow {
  float at_left, per_pixel;
  float steepness(int column) const {
    return std::min(std::max(at_left + per_pixel * static_cast<float>(column), 0.0f), 1.0f);
  }
};

SkyRow sky_row(const Eye& eye, int row) {
  const Eigen::Vector3d up = eye.T_world_camera.linear().row(2) / eye.focal_px;  // world z in camera axes
  const double left = -eye.center_x_px * up.x() + (row - eye.center_y_px) * up.y() + eye.focal_px * up.z();
  return {static_cast<float>(left), static_cast<float>(up.x())};
}

}  // namespace

ImageNoise::ImageNoise(double deviation_gray, std::uint64_t seed)
    : silent_(deviation_gray <= 0), generator_(seed) {
  if (silent_) return;
  table_ = rounded_gaussians(table_size, deviation_gray, generator_);
}

void ImageNoise::add_to(cv::Mat& gray) {
  if (silent_) return;
  const int columns =
      gray.cols;  // a local copy: bytes could alias a member, and the loop would not become SIMD
  for (int row = 0; row < gray.rows; ++row) {
    const std::int8_t* noise =
        table_.data() + generator_() % (table_size - static_cast<std::size_t>(columns));
    std::uint8_t* pixel = gray.ptr<std::uint8_t>(row);
    for (int column = 0; column < columns; ++column) {
      const std::int16_t sum = static_cast<std::int16_t>(pixel[column] + noise[column]);
      pixel[column] = static_cast<std::uint8_t>(std::min<std::int16_t>(std::max<std::int16_t>(sum, 0), 255));
    }
  }
}

cv::Mat gray_with_sky(const std::uint8_t* rgba, int stride_px, const Eye& eye) {
  static_assert(std::endian::native == std::endian::little);
  cv::Mat gray(eye.height_px, eye.width_px, CV_8UC1);
  const int columns = eye.width_px;
  for (int row = 0; row < eye.height_px; ++row) {
    const std::uint8_t* source = rgba + std::size_t{4} * stride_px * (eye.height_px - 1 - row);
    std::uint8_t* target = gray.ptr<std::uint8_t>(row);
    const SkyRow sky = sky_row(eye, row);
    for (int column = 0; column < columns; ++column) {
      const float bright = horizon_gray + (zenith_gray - horizon_gray) * sky.steepness(column);
      std::uint32_t pixel;
      std::memcpy(&pixel, source + 4 * column, sizeof pixel);
      const int green = static_cast<int>(pixel >> 8 & 0xFF), sky_gray = static_cast<int>(bright);
      target[column] = static_cast<std::uint8_t>(pixel >> 24 != 0 ? green : sky_gray);
    }
  }
  return gray;
}

cv::Mat colour_with_sky(const std::uint8_t* rgba, const Eye& eye) {
  cv::Mat colour(eye.height_px, eye.width_px, CV_8UC3);
  for (int row = 0; row < eye.height_px; ++row) {
    const std::uint8_t* source = rgba + std::size_t{4} * eye.width_px * (eye.height_px - 1 - row);
    auto* target = colour.ptr<cv::Vec3b>(row);
    const SkyRow sky = sky_row(eye, row);
    for (int column = 0; column < eye.width_px; ++column, source += 4) {
      const float blue = sky.steepness(column);
      const cv::Vec3b air(cv::saturate_cast<std::uint8_t>(235 - 10 * blue),
                          cv::saturate_cast<std::uint8_t>(218 - 30 * blue),
                          cv::saturate_cast<std::uint8_t>(205 - 60 * blue));
      target[column] = source[3] != 0 ? cv::Vec3b(source[2], source[1], source[0]) : air;
    }
  }
  return colour;
}

}  // namespace understory
