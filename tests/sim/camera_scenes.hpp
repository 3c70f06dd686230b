#pragma once

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/cameras/stereo_cameras.hpp"
#include "tests/perception/rigs.hpp"

/// Small worlds to point cameras at, and where things stand in their images.
namespace understory {

using support::paper_rig;

/// A world of the test's own: an aircraft that can be put anywhere, and `geoms` in the drawn group.
inline World bare_world(const std::string& geoms) {
  const std::string xml =
      "<mujoco><worldbody>" + geoms +
      "<body name='aircraft'><freejoint name='aircraft_free'/><geom size='.1' mass='1' group='3'/></body>"
      "</worldbody></mujoco>";
  mjVFS files;
  mj_defaultVFS(&files);
  mj_makeEmptyFileVFS(&files, "bare.xml", static_cast<int>(xml.size()));
  std::copy(xml.begin(), xml.end(), static_cast<char*>(files.filedata[0]));
  char message[500] = "";
  World world{ModelPointer(mj_loadXML("bare.xml", &files, message, sizeof message)), {}};
  mj_deleteVFS(&files);
  if (!world.model) throw std::runtime_error(message);
  return world;
}

inline Eigen::Isometry3d body_at(const Eigen::Vector3d& position, const Eigen::Quaterniond& attitude) {
  return Eigen::Translation3d(position) * attitude;
}

/// MuJoCo's state of the world with its aircraft there.
inline DataPointer data_at(const World& world, const Eigen::Isometry3d& T_world_body) {
  DataPointer data(mj_makeData(world.model.get()));
  const Eigen::Vector3d& position = T_world_body.translation();
  const Eigen::Quaterniond attitude(T_world_body.linear());
  const double pose[] = {position.x(), position.y(), position.z(), attitude.w(),
                         attitude.x(), attitude.y(), attitude.z()};
  std::copy(std::begin(pose), std::end(pose), data->qpos);
  mj_kinematics(world.model.get(), data.get());
  return data;
}

inline const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
inline const Eigen::Quaterniond straight_down(Eigen::AngleAxisd(std::numbers::pi / 2,
                                                                Eigen::Vector3d::UnitY()));
inline CameraConfig noiseless() { return {.noise_gray = 0}; }

/// The source tree's; that of UNDERSTORY_ROOT where a test was carried to another machine (tests/gpu/run).
inline std::filesystem::path models_folder() {
  const char* root = std::getenv("UNDERSTORY_ROOT");
  return std::filesystem::path(root != nullptr ? root : UNDERSTORY_SOURCE_DIR) / "models";
}

inline World forest_world(bool visible = true) {
  std::vector<Obstacle> obstacles;
  for (int i = 0; i < 12; ++i) {
    Obstacle trunk;
    trunk.from_world = Eigen::Vector3d(4 + 2 * i, (i % 5 - 2) * 1.7, 0);
    trunk.to_world = trunk.from_world + Eigen::Vector3d(0, 0, 9);
    trunk.texture_shift = 0.08 * i;
    obstacles.push_back(trunk);
  }
  WorldConfig config;
  config.obstacles_visible = visible;
  return build_world(models_folder(), Airframe{}, obstacles, config);
}

/// The depths of the ground below an empty forest, seen with the nose down, are by pencil.
inline void expect_depths_of_the_ground(StereoCameras& cameras, const StereoRig& rig) {
  const double height_m = 2, pitch_rad = 0.3;  // nose down
  const Eigen::Quaterniond attitude(Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()));
  const cv::Mat depth = cameras.depth(body_at({10, 0, height_m}, attitude));
  for (int row = 130; row < 240; row += 10)
    for (int column = 3; column < 376; column += 31) {
      const Eigen::Vector3d ray_camera((column - rig.center_left_x_px) / rig.focal_px,
                                       (row - rig.center_y_px) / rig.focal_px, 1);
      const double falls = -(attitude * rig.T_body_camera.linear() * ray_camera).z();
      EXPECT_NEAR(depth.at<float>(row, column), height_m / falls, 0.001) << row << ", " << column;
    }
}

inline bool equal(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF) == 0; }

/// Where a dark ball stands in a bright sky: the centroid of what it takes away.
inline Eigen::Vector2d dark_centroid(const cv::Mat& image) {
  double weight = 0, u = 0, v = 0;
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.cols; ++column)
      if (const int dark = image.at<std::uint8_t>(row, column) < 120; dark != 0) {
        weight += dark;
        u += column;
        v += row;
      }
  return weight > 0 ? Eigen::Vector2d(u / weight, v / weight) : Eigen::Vector2d(-1, -1);
}

/// A black ball in front of nothing but sky.
inline World black_ball(const Eigen::Vector3d& at, double radius_m) {
  return bare_world("<geom type='sphere' size='" + std::to_string(radius_m) + "' rgba='0 0 0 1' pos='" +
                    std::to_string(at.x()) + " " + std::to_string(at.y()) + " " + std::to_string(at.z()) +
                    "'/>");
}

/// Where what an image lacks of the sky lies (it may be blurred): its mean place and the variance of its
/// columns, px.
struct Shade {
  Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();
  double columns_variance_px2 = 0;
};
inline Shade shade(const cv::Mat& image, const cv::Mat& sky) {
  double weight = 0, squares = 0;
  Eigen::Vector2d sum(0, 0);
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.cols; ++column) {
      const double dark = sky.at<std::uint8_t>(row, column) - image.at<std::uint8_t>(row, column);
      weight += dark, squares += dark * column * column;
      sum += dark * Eigen::Vector2d(column, row);
    }
  const Eigen::Vector2d mean_px = sum / weight;
  return {mean_px, squares / weight - mean_px.x() * mean_px.x()};
}

}  // namespace understory
