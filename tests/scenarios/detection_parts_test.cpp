#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/detect/posed_map.hpp"
#include "scenarios/report/pictures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

TEST(PictureFolder, AppearsWholeOrNotAtAll) {
  const support::TemporaryFolder folder;
  const fs::path pictures = folder.path() / "overlays";
  const cv::Mat picture(4, 6, CV_8UC3, cv::Scalar(1, 2, 3));
  {
    PictureFolder broken_off(pictures);
    broken_off.add(picture);
    EXPECT_FALSE(fs::exists(pictures));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
  for (const int count : {2, 1}) {
    PictureFolder made(pictures);
    for (int i = 0; i < count; ++i) made.add(picture);
    made.finish();
    EXPECT_EQ(std::distance(fs::directory_iterator(pictures), fs::directory_iterator()), count);
  }
  std::ofstream(pictures / "notes.txt") << "mine";
  PictureFolder refused(pictures);
  refused.add(picture);
  EXPECT_THROW(refused.finish(), ScenarioError);
  EXPECT_TRUE(fs::exists(pictures / "notes.txt"));
}

/// A camera that looks along world x whatever the body's axes are, moved along x at 1 m/s.
TEST(PosedMap, ForgetsWhatTheCameraHasPassedWhateverTheBodysAxes) {
  Eigen::Matrix3d looks_along_x;  // camera (right, down, ahead) into world (ahead, left, up)
  looks_along_x << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  for (const Eigen::Quaterniond& body :
       {Eigen::Quaterniond::Identity(), Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5)}) {
    Eigen::Isometry3d T_body_camera = Eigen::Isometry3d::Identity();
    T_body_camera.linear() = body.toRotationMatrix().transpose() * looks_along_x;
    const auto T_world_camera = [&](double x_m) {
      return Eigen::Translation3d(x_m, 0, 0) * Eigen::Isometry3d(body) * T_body_camera;
    };
    LocalMapConfig config;
    config.passed_m = 1;
    config.max_age_s = 100;
    PosedMap map(config);
    StereoHit hit;
    hit.position_camera = {0.5, -0.25, 3};
    map.insert({hit}, T_world_camera(2), 2'000'000'000);
    ASSERT_EQ(map.points().size(), 1u);
    EXPECT_TRUE(map.points()[0].position_world.isApprox(Eigen::Vector3d(5, -0.5, 0.25), 1e-12));
    map.insert({}, T_world_camera(5.9), 5'900'000'000);
    EXPECT_EQ(map.points().size(), 1u);
    map.insert({}, T_world_camera(6.1), 6'100'000'000);
    EXPECT_EQ(map.points().size(), 0u);
  }
}

TEST(PosedMap, CountsWhatWasFlownBetweenFrames) {
  PosedMap map(LocalMapConfig{});
  StereoHit hit;
  hit.position_camera = {0, 0, 5};
  map.insert({}, Eigen::Isometry3d::Identity(), 0);
  map.insert({hit}, Eigen::Isometry3d(Eigen::Translation3d(1.5, 2, 0)), 5'000'000'000);
  ASSERT_EQ(map.points().size(), 1u);
  EXPECT_NEAR(map.points()[0].distance_flown_m, 2.5, 1e-12);
}

}  // namespace
}  // namespace understory
