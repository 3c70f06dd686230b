#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <random>
#include <vector>

#include "sim/cameras/camera_frustum.hpp"

namespace understory {

/// Gaussian noise for whole images with less than one random draw per pixel. A table of 2^19 rounded draws is
/// made once. Every image row reads it from a random position. Rounding adds 1/12 to the variance. About one
/// pair of rows in a thousand overlaps in the table.
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
