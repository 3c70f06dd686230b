#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/detect/posed_map.hpp"
#include "scenarios/report/picture_folder.hpp"
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
    StereoRig rig;
    rig.T_body_camera.linear() = body.toRotationMatrix().transpose() * looks_along_x;
    std::vector<TimedPose> poses(2);
    poses[0].T_world_body = poses[1].T_world_body = Eigen::Isometry3d(body);
    poses[1].t_ns = 10'000'000'000;
    poses[1].T_world_body.translation().x() = 10;
    LocalMapConfig config;
    config.passed_m = 1;
    config.max_age_s = 100;
    PosedMap map(poses, rig, config);
    StereoHit hit;
    hit.position_camera = {0.5, -0.25, 3};
    EXPECT_TRUE(map.insert({hit}, 2'000'000'000));
    ASSERT_EQ(map.points().size(), 1u);
    EXPECT_TRUE(map.points()[0].position_world.isApprox(Eigen::Vector3d(5, -0.5, 0.25), 1e-12));
    EXPECT_TRUE(map.insert({}, 5'900'000'000));
    EXPECT_EQ(map.points().size(), 1u);
    EXPECT_TRUE(map.insert({}, 6'100'000'000));
    EXPECT_EQ(map.points().size(), 0u);
    EXPECT_FALSE(map.insert({hit}, 11'000'000'000));
    EXPECT_EQ(map.remembered().size(), 1u);
  }
}

TEST(PosedMap, CountsWhatWasFlownBetweenFrames) {
  std::vector<TimedPose> poses(2);
  poses[1].t_ns = 10'000'000'000;
  poses[1].T_world_body.translation() = Eigen::Vector3d(3, 4, 0);
  PosedMap map(poses, StereoRig{}, {});
  StereoHit hit;
  hit.position_camera = {0, 0, 5};
  map.insert({}, 0);
  map.insert({hit}, 5'000'000'000);
  ASSERT_EQ(map.remembered().size(), 1u);
  EXPECT_NEAR(map.remembered()[0].distance_flown_m, 2.5, 1e-12);
}

}  // namespace
}  // namespace understory
