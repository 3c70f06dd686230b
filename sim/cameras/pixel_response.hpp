#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <random>
#include <vector>

#include "sim/cameras/camera_config.hpp"

namespace understory {

/// From the picture on the sensor to the gray level read: falloff of the lens, light, full well, shot noise,
/// amplifier. With S the gray level on a pixel,
///   seen = min(light * falloff * S, 255),   read = gain * (seen + sqrt(255 / full_well_e * seen) * z),
/// z standard normal (for Poisson's law: pixels hold hundreds of electrons), so that the variance of the
/// reading grows with its mean with the slope gain * 255 / full_well_e: the photon transfer curve (EMVA
/// 1288).
class PixelResponse {
 public:
  /// `falloff`: of each eye, CV_32FC1 of the images' size, 1 at full brightness; may be empty for none.
  PixelResponse(const CameraConfig& config, std::array<cv::Mat, 2> falloff, std::uint64_t seed);
  /// Changes the image in place, CV_8UC1; rounds to the nearest gray level, clamped to 0 .. 255. Does nothing
  /// where light and gain are 1 and neither falloff nor shot noise is asked for. eye: 0 left, 1 right.
  void apply(int eye, cv::Mat& gray);

 private:
  bool neutral_;
  float light_, gain_, variance_per_gray_;
  std::array<cv::Mat, 2> falloff_;
  std::vector<float>
      normal_;  ///< standard normal draws; every row reads a stretch of its own (see ImageNoise)
  std::mt19937_64 generator_;
};

}  // namespace understory
