#include "tests/support/synthetic_stereo.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>

namespace understory::support {
namespace {

/// A value in -1 .. 1 belonging to a lattice point, from a mixing of its coordinates (splitmix64's
/// finaliser).
double lattice(std::int64_t i, std::int64_t j, std::uint64_t seed) {
  std::uint64_t x = seed * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(i) * 0xBF58476D1CE4E5B9u +
                    static_cast<std::uint64_t>(j) * 0x94D049BB133111EBu;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1.0p-52 - 1.0;
}

/// Bilinear between lattice points one unit apart; period in units along s, 0 for none.
double texture(double s, double t, std::int64_t period, std::uint64_t seed) {
  const double fs = std::floor(s), ft = std::floor(t);
  const double a = s - fs, b = t - ft;
  const auto j = static_cast<std::int64_t>(ft);
  const auto wrap = [period](std::int64_t i) { return period > 0 ? ((i % period) + period) % period : i; };
  const std::int64_t i0 = wrap(static_cast<std::int64_t>(fs)), i1 = wrap(static_cast<std::int64_t>(fs) + 1);
  const double upper = (1 - a) * lattice(i0, j, seed) + a * lattice(i1, j, seed);
  const double lower = (1 - a) * lattice(i0, j + 1, seed) + a * lattice(i1, j + 1, seed);
  return (1 - b) * upper + b * lower;
}

/// One scale of the plane's brightness where it appears at (u, v) of an eye whose axis were at the image's
/// origin.
double scale(double u, double v, double grain_px, double repeats_every_px, std::uint64_t seed) {
  // A period need not be a whole number of grains: the grain gives way.
  const bool repeats = repeats_every_px > 0;
  const auto period = repeats ? std::max<std::int64_t>(1, std::llround(repeats_every_px / grain_px)) : 0;
  const double used_px = repeats ? repeats_every_px / static_cast<double>(period) : grain_px;
  return texture(u / used_px, v / grain_px, period, seed);
}

cv::Mat view(const StereoRig& rig, const SyntheticPlane& plane, double camera_x_m, double center_x_px,
             std::mt19937_64& generator) {
  std::normal_distribution<double> noise(0.0, 1.0);
  cv::Mat image(rig.height_px, rig.width_px, CV_8UC1);
  const double camera_x_px = rig.focal_px / plane.depth_m * camera_x_m;
  for (int row = 0; row < rig.height_px; ++row) {
    for (int column = 0; column < rig.width_px; ++column) {
      const double u = column - center_x_px + camera_x_px, v = row - rig.center_y_px;
      const double value = 128 +
                           plane.contrast * scale(u, v, plane.grain_px, plane.repeats_every_px, plane.seed) +
                           plane.coarse_contrast *
                               scale(u, v, plane.coarse_grain_px, plane.repeats_every_px, plane.seed + 1000);
      image.at<std::uint8_t>(row, column) =
          cv::saturate_cast<std::uint8_t>(value + plane.noise_gray_levels * noise(generator));
    }
  }
  return image;
}

}  // namespace

StereoFrame render_plane(const StereoRig& rig, const SyntheticPlane& plane) {
  std::mt19937_64 generator(plane.seed);
  StereoFrame frame;
  frame.left = view(rig, plane, 0.0, rig.center_left_x_px, generator);
  frame.right = view(rig, plane, rig.baseline_m, rig.center_right_x_px, generator);
  return frame;
}

}  // namespace understory::support
