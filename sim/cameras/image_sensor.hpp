#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <random>
#include <vector>

#include "sim/cameras/camera_frustum.hpp"

namespace understory {

/// Gaussian noise for whole images at a fraction of a draw per pixel: a table of 2^19 rounded draws is made
/// once, and every image row reads it from a place of its own, drawn afresh from the seeded generator.
/// Rounding adds 1/12 to the variance. Two rows of a pair share a stretch of the table about once in a
/// thousand.
class ImageNoise {
 public:
  ImageNoise(double deviation_gray, std::uint64_t seed);
  /// Adds to every pixel, clamped to 0 .. 255.
  void add_to(cv::Mat& gray);

 private:
  bool silent_;
  std::vector<std::int8_t> table_;
  std::mt19937_64 generator_;
};

/// Gray image of one eye from rendered RGBA (rows bottom up, `stride_px` pixels each): green where something
/// was drawn, and elsewhere (alpha 0) the sky, bright at the horizon and a little darker overhead.
cv::Mat gray_with_sky(const std::uint8_t* rgba, int stride_px, const Eye& eye);
/// The same for people: BGR with a blue sky.
cv::Mat colour_with_sky(const std::uint8_t* rgba, const Eye& eye);

}  // namespace understory
