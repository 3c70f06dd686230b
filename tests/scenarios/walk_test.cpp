#include "scenarios/recording/carried_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "perception/io/pose_file.hpp"
#include "scenarios/flight/clearance.hpp"
#include "scenarios/recording/euroc_texts.hpp"
#include "scenarios/recording/record.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

const fs::path root = UNDERSTORY_SOURCE_DIR;

Scenario library_scenario(const std::string& name, const std::vector<std::string>& settings = {}) {
  return load_scenario(root / "scenarios/library" / (name + ".yaml"), settings);
}

WalkPath path_of(const Scenario& scenario, const WalkConfig& config = {}) {
  return walk_path(config, scenario, rig_of(scenario, root / "models").rig, course_obstacles(scenario));
}

TEST(Walk, KeepsItsPaceItsHeightAndTheCamerasLevel) {
  const Scenario scenario = library_scenario("forest", {"seed=1003"});
  const WalkPath path = path_of(scenario, {1.2, 1.6});
  const StereoRig rig = rig_of(scenario, root / "models").rig;
  Eigen::Vector3d sum_velocity = Eigen::Vector3d::Zero(), sum_gaze = sum_velocity;
  const int count = 20 * 200;
  for (int i = 0; i < count; ++i) {
    const Truth truth = walk_truth(path, i * std::int64_t{5'000'000});
    sum_velocity += truth.velocity_world_mps;
    sum_gaze += truth.T_world_body.linear() * rig.T_body_camera.linear().col(2);
    EXPECT_NEAR(truth.T_world_body.translation().z(), 1.6, 0.0201);
    EXPECT_NEAR(truth.T_world_body.translation().y(), path.lane_y_m, 0.0251);
  }
  EXPECT_LT((sum_velocity / count - Eigen::Vector3d(1.2, 0, 0)).norm(), 0.01);
  EXPECT_NEAR(sum_gaze.normalized().z(), 0, 0.002);
  EXPECT_GT(sum_gaze.normalized().x(), 0.999);
}

/// Strapdown navigation: rates and specific force, integrated, give the path back.
TEST(Walk, WhatAnImuWouldFeelIsThePathsOwn) {
  const WalkPath path = path_of(library_scenario("forest", {"seed=1003"}));
  const Truth start = walk_truth(path, 0);
  Eigen::Quaterniond q(start.T_world_body.linear());
  Eigen::Vector3d v = start.velocity_world_mps, p = start.T_world_body.translation();
  const double h_s = 0.0005;
  const auto turned_by = [](const Eigen::Vector3d& rotation) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
  };
  for (int i = 0; i < 6000; ++i) {  // 3 s, midpoints
    const Truth middle = walk_truth(path, i * std::int64_t{500'000} + 250'000);
    const Eigen::Quaterniond q_middle = q * turned_by(0.5 * h_s * middle.angular_rate_body_radps);
    const Eigen::Vector3d a = q_middle * middle.specific_force_body_mps2 - Eigen::Vector3d(0, 0, 9.81);
    p += h_s * v + 0.5 * h_s * h_s * a;
    v += h_s * a;
    q = q * turned_by(h_s * middle.angular_rate_body_radps);
  }
  const Truth end = walk_truth(path, 3'000'000'000);
  EXPECT_LT((p - end.T_world_body.translation()).norm(), 1e-4);
  EXPECT_LT((v - end.velocity_world_mps).norm(), 1e-4);
  EXPECT_LT(q.angularDistance(Eigen::Quaterniond(end.T_world_body.linear())), 1e-5);
}

TEST(Walk, PassesEveryObstacleAtArmsLength) {
  for (int seed = 1000; seed < 1010; ++seed) {
    const Scenario scenario = library_scenario("forest", {"seed=" + std::to_string(seed)});
    const WalkPath path = path_of(scenario);
    for (const Obstacle& trunk : course_obstacles(scenario)) {
      const Segment lane{{path.from_x_m, path.lane_y_m, 1.7}, {scenario.goal_x_m(), path.lane_y_m, 1.7}};
      EXPECT_GE(segment_distance_m(lane, {trunk.from_world, trunk.to_world}) - trunk.radius_m, 0.5);
    }
  }
  EXPECT_THROW(path_of(library_scenario("dense", {"forest.square_metres_per_tree=4"})), ScenarioError);
}

TEST(Walk, SeedsSwayDifferentlyAndRepeat) {
  const auto at_a_second = [](const char* seed) {
    const Scenario scenario = library_scenario("clear", {std::string("seed=") + seed});
    return walk_truth(path_of(scenario), 1'000'000'000).T_world_body;
  };
  EXPECT_TRUE(at_a_second("1000").isApprox(at_a_second("1000"), 0));
  EXPECT_FALSE(at_a_second("1000").isApprox(at_a_second("1001"), 1e-4));
}

/// Along a ray to the bark of a vertical trunk, in multiples of the ray; +infinity where it passes.
double reach_to(const Obstacle& trunk, const Eigen::Vector3d& from_world, const Eigen::Vector3d& ray_world) {
  const double none = std::numeric_limits<double>::infinity();
  const Eigen::Vector2d o = (from_world - trunk.from_world).head<2>(), d = ray_world.head<2>();
  const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - trunk.radius_m * trunk.radius_m;
  if (b * b < a * c || b > 0) return none;
  const double reach = (-b - std::sqrt(b * b - a * c)) / a;
  const double z = from_world.z() + reach * ray_world.z();
  return z < trunk.from_world.z() || z > trunk.to_world.z() ? none : reach;
}

TEST(Walk, TheRecordedDepthOfTrunksIsThatOfTheirCylinders) {
  const support::TemporaryFolder folder;
  const Scenario scenario =
      library_scenario("forest", {"seed=1003", "time_limit_s=0.5", "cameras.rate_hz=2",
                                  "forest.square_metres_per_tree=20", "forest.length_m=20"});
  FlyOptions options;
  options.models_folder = root / "models";
  options.output_folder = folder.path();
  walk_recorded(scenario, {}, options);
  const StereoRig rig = read_calibrated_rig(folder.path(), {}).rig;
  const auto poses = read_poses(folder.path() / "mav0/state_groundtruth_estimate0/data.csv");
  const std::string name = std::to_string(recorded_ns(0)) + ".png";
  const cv::Mat depth =
      cv::imread((folder.path() / "mav0/depth0/data" / name).string(), cv::IMREAD_UNCHANGED);
  const Eigen::Isometry3d T_world_camera = pose_at(poses, recorded_ns(0)).value() * rig.T_body_camera;
  int seen = 0, agreed = 0;
  for (int row = 0; row < rig.height_px; row += 2)
    for (int column = 0; column < rig.width_px; ++column) {
      const Eigen::Vector3d ray_camera((column - rig.center_left_x_px) / rig.focal_px,
                                       (row - rig.center_y_px) / rig.focal_px, 1);
      const Eigen::Vector3d ray_world = T_world_camera.linear() * ray_camera;
      double nearest_m = std::numeric_limits<double>::infinity();
      for (const Obstacle& trunk : course_obstacles(scenario))
        nearest_m = std::min(nearest_m, reach_to(trunk, T_world_camera.translation(), ray_world));
      if (nearest_m > 25) continue;
      ++seen;
      agreed += std::abs(depth.at<std::uint16_t>(row, column) - 1000 * nearest_m) < 20 ? 1 : 0;
    }
  EXPECT_GT(seen, 2000);
  EXPECT_GT(agreed, 0.95 * seen);  // the rest: outlines, where the drawn trunk has flat sides
}

/// The ground at height h lies where a pixel's ray has fallen by h: read back from the PNG and the poses.
TEST(Walk, TheRecordedDepthOfTheGroundIsTheRaysOwn) {
  const support::TemporaryFolder folder;
  const Scenario scenario = library_scenario("clear", {"time_limit_s=0.5", "cameras.rate_hz=10"});
  FlyOptions options;
  options.models_folder = root / "models";
  options.output_folder = folder.path();
  const RecordedWalk walk = walk_recorded(scenario, {1.4, 1.7}, options);
  EXPECT_EQ(walk.carried.frames, 5);
  EXPECT_FALSE(fs::exists(folder.path() / "mav0/estimate0"));

  const StereoRig rig = read_calibrated_rig(folder.path(), {}).rig;
  const auto poses = read_poses(folder.path() / "mav0/state_groundtruth_estimate0/data.csv");
  for (const std::int64_t t_ns : {0, 300'000'000}) {
    const std::string name = std::to_string(recorded_ns(t_ns)) + ".png";
    const cv::Mat depth =
        cv::imread((folder.path() / "mav0/depth0/data" / name).string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(depth.type(), CV_16UC1);
    const Eigen::Isometry3d T_world_camera = pose_at(poses, recorded_ns(t_ns)).value() * rig.T_body_camera;
    for (int row = 170; row < rig.height_px; row += 10)
      for (int column = 3; column < rig.width_px; column += 31) {
        const Eigen::Vector3d ray_camera((column - rig.center_left_x_px) / rig.focal_px,
                                         (row - rig.center_y_px) / rig.focal_px, 1);
        const double falls = -(T_world_camera.linear() * ray_camera).z();
        const double expected_m = T_world_camera.translation().z() / falls;
        EXPECT_NEAR(depth.at<std::uint16_t>(row, column), 1000 * expected_m, 0.5 + 2e-4 * 1000 * expected_m)
            << row << ", " << column;
      }
    EXPECT_EQ(depth.at<std::uint16_t>(3, 100), 0);  // the sky
  }
}

}  // namespace
}  // namespace understory
