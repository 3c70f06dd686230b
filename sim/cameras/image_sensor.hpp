#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <random>
#include <vector>

#include "sim/cameras/camera_config.hpp"

namespace understory {

/// Gaussian noise for whole images with less than one random draw per pixel. A table of 2^19 rounded draws is
/// made once. Every image row reads it from a random position. Rounding adds 1/12 to the variance. About one
/// pair of rows in a thousand overlaps in the table.
class ImageNoise {
 public:
  ImageNoise(double deviation_gray, std::uint64_t seed);
  /// Adds to every pixel, clamped to 0 .. 255; the noise `gain` times as large.
  void add_to(cv::Mat& gray, float gain = 1);
  /// From now on other noise.
  void redraw(std::uint64_t seed) { generator_.seed(seed); }

 private:
  bool silent_;
  std::vector<std::int8_t> table_;
  std::mt19937_64 generator_;
};

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
  /// if light and gain are 1 and there is neither falloff nor shot noise. eye: 0 left, 1 right. `automatic`:
  /// of the exposure below 1, of the gain above.
  void apply(int eye, cv::Mat& gray, float automatic = 1);
  void redraw(std::uint64_t seed) { generator_.seed(seed); }

 private:
  bool neutral_;
  float light_, gain_, variance_per_gray_;
  std::array<cv::Mat, 2> falloff_;
  std::vector<float>
      normal_;  ///< standard normal draws; every row reads a stretch of its own (see ImageNoise)
  std::mt19937_64 generator_;
};

/// The automatic exposure of a pair of cameras: a factor that follows the images' brightness with a lag.
class AutoExposure {
 public:
  explicit AutoExposure(const CameraConfig& config)
      : lag_s_(config.auto_exposure_s), target_gray_(config.auto_exposure_gray) {}
  /// The factor for the frame that is taken now.
  float factor() const { return static_cast<float>(factor_); }
  /// Takes a frame that was exposed with factor(): the next one's is nearer to what would have made its mean
  /// the target, by 1 - exp(-time / lag) of the logarithm. Between 1/64 and 64.
  void observe(const cv::Mat& gray, std::int64_t t_ns);

 private:
  double lag_s_, target_gray_;
  double factor_ = 1;
  std::int64_t before_ns_ = -1;
};

/// `count` (even) draws of libstdc++'s std::normal_distribution of mean 0 and this deviation, each rounded by
/// std::lround and cut to -127..127: the same numbers from the same draws of the generator, at less than half
/// the time. Every flight with image noise draws half a million at its start.
std::vector<std::int8_t> rounded_gaussians(std::size_t count, double deviation, std::mt19937_64& generator);

}  // namespace understory
