#include "scenarios/bench/bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <random>

namespace understory {
namespace {

constexpr double sky_gray = 205;
constexpr double mid_gray = 110;

struct Trunk {
  double x_m = 0, z_m = 0, radius_m = 0;
};

/// Camera frame without roll: x right, y down, z ahead.
struct Scene {
  double ground_y_m = 4;
  double roll_rad = 0;
  std::vector<Trunk> trunks;  // nearest first
  std::uint32_t texture_seed = 0;
};

Scene scene_of(std::mt19937_64& generator) {
  const auto uniform = [&](double minimum, double maximum) {
    return std::uniform_real_distribution<double>(minimum, maximum)(generator);
  };
  Scene scene;
  scene.ground_y_m = uniform(2.5, 5);
  scene.roll_rad = uniform(-0.7, 0.7);
  for (int i = 0; i < 60; ++i) scene.trunks.push_back({uniform(-22, 22), uniform(2, 40), uniform(0.1, 0.25)});
  std::sort(scene.trunks.begin(), scene.trunks.end(),
            [](const Trunk& a, const Trunk& b) { return a.z_m < b.z_m; });
  scene.texture_seed = static_cast<std::uint32_t>(generator());
  return scene;
}

/// A number in -1 .. 1 for each point of a lattice.
double lattice(int a, int b, std::uint32_t seed) {
  std::uint32_t h =
      static_cast<std::uint32_t>(a) * 0x9E3779B1u ^ static_cast<std::uint32_t>(b) * 0x85EBCA77u ^ seed;
  h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
  h = (h ^ (h >> 12)) * 0x297A2D39u;
  return static_cast<double>(h ^ (h >> 15)) / 2147483648.0 - 1;
}

double smooth_noise(double s, double t, std::uint32_t seed) {
  const double floor_s = std::floor(s), floor_t = std::floor(t);
  const auto a = static_cast<int>(floor_s), b = static_cast<int>(floor_t);
  const auto ease = [](double x) { return x * x * (3 - 2 * x); };
  const double x = ease(s - floor_s), y = ease(t - floor_t);
  const double low = lattice(a, b, seed) * (1 - x) + lattice(a + 1, b, seed) * x;
  const double high = lattice(a, b + 1, seed) * (1 - x) + lattice(a + 1, b + 1, seed) * x;
  return low * (1 - y) + high * y;
}

/// Surface brightness at (s, t) metres; waves shorter than the pixel's footprint fade out, as a lens has it.
double texture(double s_m, double t_m, double footprint_m, std::uint32_t seed) {
  constexpr std::array<double, 6> waves_m{2.0, 0.7, 0.25, 0.09, 0.035, 0.013};
  double gray = mid_gray;
  for (std::size_t i = 0; i < waves_m.size(); ++i) {
    const double share = 1 - 0.8 * footprint_m / waves_m[i];
    if (share > 0)
      gray +=
          34 * share * smooth_noise(s_m / waves_m[i], t_m / waves_m[i], seed + static_cast<std::uint32_t>(i));
  }
  return gray;
}

/// What a ray from `eye` along (x, y, 1), both without roll, sees.
double gray_along(const Scene& scene, const cv::Point2d& eye, double x, double y, double pixel_rad) {
  double depth_m = y > 1e-3 ? (scene.ground_y_m - eye.y) / y : 1e9;
  const Trunk* seen = nullptr;
  for (const Trunk& trunk : scene.trunks) {
    if (trunk.z_m - trunk.radius_m > depth_m) break;
    const double aside_m = trunk.x_m - eye.x;
    const double a = x * x + 1, b = x * aside_m + trunk.z_m;
    const double c = aside_m * aside_m + trunk.z_m * trunk.z_m - trunk.radius_m * trunk.radius_m;
    const double discriminant = b * b - a * c;
    if (discriminant <= 0) continue;
    const double here_m = (b - std::sqrt(discriminant)) / a;
    if (here_m <= 0 || here_m >= depth_m) continue;
    depth_m = here_m;
    seen = &trunk;
  }
  const double footprint_m = depth_m * pixel_rad;
  if (seen != nullptr) {
    const double around_rad = std::atan2(eye.x + x * depth_m - seen->x_m, seen->z_m - depth_m);
    const auto seed = scene.texture_seed + static_cast<std::uint32_t>(1000 * seen->z_m);
    return 0.85 * texture(around_rad * seen->radius_m, eye.y + y * depth_m, footprint_m, seed);
  }
  if (depth_m > 80) return sky_gray;
  // The ground is seen at a shallow angle: a pixel covers more of it along than across.
  return texture(eye.x + x * depth_m, depth_m, footprint_m / std::sqrt(std::max(0.05, y)),
                 scene.texture_seed + 77);
}

/// Directions (x, y, 1) in the rectified camera's frame of every pixel of the images that the rig delivers.
std::vector<cv::Point2d> directions(const CalibratedRig& rig, bool is_left) {
  std::vector<cv::Point2d> pixels, rays;
  for (int v = 0; v < rig.rig.height_px; ++v)
    for (int u = 0; u < rig.rig.width_px; ++u) pixels.emplace_back(u, v);
  if (rig.calibration) {
    const CameraCalibration& camera = is_left ? rig.calibration->left : rig.calibration->right;
    cv::undistortPoints(pixels, rays, camera.camera_matrix, camera.distortion, camera.rectification);
    return rays;
  }
  const double center_px = is_left ? rig.rig.center_left_x_px : rig.rig.center_right_x_px;
  for (const cv::Point2d& pixel : pixels)
    rays.emplace_back((pixel.x - center_px) / rig.rig.focal_px,
                      (pixel.y - rig.rig.center_y_px) / rig.rig.focal_px);
  return rays;
}

/// `aside_m`: how far right of the left eye it sits, along the rolled wing.
cv::Mat picture(const Scene& scene, const StereoRig& rig, const std::vector<cv::Point2d>& rays,
                double aside_m, std::mt19937_64& generator) {
  std::normal_distribution<double> noise(0, 2);
  const double c = std::cos(scene.roll_rad), s = std::sin(scene.roll_rad);
  const auto without_roll = [&](const cv::Point2d& p) {
    return cv::Point2d(c * p.x - s * p.y, s * p.x + c * p.y);
  };
  const cv::Point2d eye = without_roll({aside_m, 0});
  cv::Mat image(rig.height_px, rig.width_px, CV_8UC1);
  auto pixel = image.begin<std::uint8_t>();
  for (const cv::Point2d& ray : rays) {
    const cv::Point2d level = without_roll(ray);
    const double gray = gray_along(scene, eye, level.x, level.y, 1 / rig.focal_px) + noise(generator);
    *pixel++ = static_cast<std::uint8_t>(std::clamp(gray, 0.0, 255.0));
  }
  return image;
}

}  // namespace

std::vector<StereoFrame> stereo_scenes(const CalibratedRig& rig, int count, std::uint64_t seed) {
  const std::vector<cv::Point2d> left_rays = directions(rig, true), right_rays = directions(rig, false);
  std::mt19937_64 generator(seed);
  std::vector<StereoFrame> frames;
  for (int i = 0; i < count; ++i) {
    const Scene scene = scene_of(generator);
    frames.push_back({i, picture(scene, rig.rig, left_rays, 0, generator),
                      picture(scene, rig.rig, right_rays, rig.rig.baseline_m, generator)});
  }
  return frames;
}

}  // namespace understory
