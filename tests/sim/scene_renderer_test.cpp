#include "sim/render/scene_renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/scene/scenery.hpp"
#include "tests/sim/camera_scenes.hpp"

namespace understory {
namespace {

constexpr double view_distance_m = 25;

/// A forest that reaches far beyond the view distance, all round.
World wide_forest() {
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> place(-60, 60), radius(0.1, 0.25);
  std::vector<Obstacle> obstacles(300);
  for (Obstacle& trunk : obstacles) {
    trunk.from_world = {place(generator), place(generator), 0};
    trunk.to_world = trunk.from_world + Eigen::Vector3d(0, 0, 9);
    trunk.radius_m = radius(generator);
  }
  World world =
      build_world(std::filesystem::path(UNDERSTORY_SOURCE_DIR) / "models", Airframe{}, obstacles, {});
  paint_textures(*world.model, world.config);
  return world;
}

Eigen::Isometry3d flown_pose(int i) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(3.0 * i - 18, 11 - 2.0 * i, 1.5 + 0.4 * i);
  pose.linear() = (Eigen::AngleAxisd(0.7 * i, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(0.05 * i - 0.3, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(0.25 * i - 1.5, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

TEST(SceneRenderer, CullingTakesNothingAwayUpToTheViewDistance) {
  const World world = wide_forest();
  const StereoRig rig = paper_rig();
  const int width_px = 2 * rig.width_px;
  SceneRenderer culling(*world.model, view_distance_m, width_px, rig.height_px, RendererKind::osmesa);
  SceneRenderer drawing_all(*world.model, view_distance_m, width_px, rig.height_px, RendererKind::osmesa);
  drawing_all.stop_culling();
  int near = 0, taken_away = 0;
  for (int i = 0; i < 12; ++i) {
    const std::array<Eye, 2> eyes = eyes_of(rig, flown_pose(i));
    const auto culled = culling.gray_pair(eyes), all = drawing_all.gray_pair(eyes);
    const cv::Mat culled_depth = culling.left_depth(eyes), all_depth = drawing_all.left_depth(eyes);
    for (int row = 0; row < rig.height_px; ++row)
      for (int column = 0; column < rig.width_px; ++column) {
        const double range_per_depth = std::hypot((column - rig.center_left_x_px) / rig.focal_px,
                                                  (row - rig.center_y_px) / rig.focal_px, 1);
        const float depth = all_depth.at<float>(row, column);
        const bool same = culled[0].at<std::uint8_t>(row, column) == all[0].at<std::uint8_t>(row, column) &&
                          culled_depth.at<float>(row, column) == depth;
        taken_away += !same;
        if (depth * range_per_depth > view_distance_m) continue;
        ++near;
        ASSERT_TRUE(same) << "pose " << i << ", row " << row << ", column " << column;
      }
  }
  EXPECT_GT(near, 100'000);
  EXPECT_GT(taken_away, 100);  // what stands beyond is not drawn
}

/// Numbering what is drawn neither moves the depth nor leaves a trace in the pictures after it.
TEST(SceneRenderer, NumberedObjectsHaveTheDepthOfThePicture) {
  const World world = wide_forest();
  const StereoRig rig = paper_rig();
  SceneRenderer plain(*world.model, view_distance_m, 2 * rig.width_px, rig.height_px, RendererKind::osmesa);
  SceneRenderer numbering(*world.model, view_distance_m, 2 * rig.width_px, rig.height_px,
                          RendererKind::osmesa);
  int on_trunks = 0;
  for (int i = 0; i < 12; ++i) {
    const std::array<Eye, 2> eyes = eyes_of(rig, flown_pose(i));
    const TrueView view = numbering.true_left_view(eyes);
    EXPECT_TRUE(equal(view.depth_m, plain.left_depth(eyes)));
    const auto after = numbering.gray_pair(eyes), expected = plain.gray_pair(eyes);
    EXPECT_TRUE(equal(after[0], expected[0]) && equal(after[1], expected[1]));
    for (int row = 0; row < rig.height_px; ++row)
      for (int column = 0; column < rig.width_px; ++column) {
        const std::uint16_t object = view.objects.at<std::uint16_t>(row, column);
        ASSERT_EQ(object == object_nothing, view.depth_m.at<float>(row, column) > 499);
        ASSERT_LT(object, object_first_obstacle + world.obstacles.size());
        on_trunks += object >= object_first_obstacle ? 1 : 0;
      }
  }
  EXPECT_GT(on_trunks, 50'000);
}

}  // namespace
}  // namespace understory
