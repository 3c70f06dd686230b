#include "scenarios/recording/carried_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "perception/io/pose_file.hpp"
#include "scenarios/flight/clearance.hpp"
#include "scenarios/recording/record.hpp"
#include "scenarios/scenario/scenario_rig.hpp"
#include "tests/scenarios/recordings.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

/// Paths that cameras are carried along, and what they leave.
namespace understory {
namespace {

namespace fs = std::filesystem;
using PathFile = support::FolderTest;
using Follow = support::FolderTest;
using support::TemporaryFolder;
constexpr double pi = std::numbers::pi;

/// Strapdown navigation over 3 s: rates and specific force, integrated, give the path back.
void expect_felt_path(const std::function<Truth(std::int64_t t_ns)>& truth_at, double tolerance) {
  const Truth start = truth_at(0);
  Eigen::Quaterniond q(start.T_world_body.linear());
  Eigen::Vector3d v = start.velocity_world_mps, p = start.T_world_body.translation();
  const double h_s = 0.0005;
  const auto turned_by = [](const Eigen::Vector3d& rotation) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
  };
  for (int i = 0; i < 6000; ++i) {  // midpoints
    const Truth middle = truth_at(i * std::int64_t{500'000} + 250'000);
    const Eigen::Quaterniond q_middle = q * turned_by(0.5 * h_s * middle.angular_rate_body_radps);
    const Eigen::Vector3d a = q_middle * middle.specific_force_body_mps2 - Eigen::Vector3d(0, 0, 9.81);
    p += h_s * v + 0.5 * h_s * h_s * a;
    v += h_s * a;
    q = q * turned_by(h_s * middle.angular_rate_body_radps);
  }
  const Truth end = truth_at(3'000'000'000);
  EXPECT_LT((p - end.T_world_body.translation()).norm(), tolerance);
  EXPECT_LT((v - end.velocity_world_mps).norm(), tolerance);
  EXPECT_LT(q.angularDistance(Eigen::Quaterniond(end.T_world_body.linear())), 1e-5);
}

/// A weave of 2 s, rolling with it.
Eigen::Isometry3d weave(double t_s) {
  return Eigen::Translation3d(9 * t_s, std::sin(pi * t_s), 3) *
         Eigen::AngleAxisd(0.8 * std::sin(pi * t_s), Eigen::Vector3d::UnitX());
}

std::vector<TimedPose> weave_at(int hz, int count) {
  std::vector<TimedPose> poses;
  for (int i = 0; i < count; ++i) {
    const double t_s = static_cast<double>(i) / hz;
    poses.push_back({7'000'000'000 + std::llround(t_s * 1e9), weave(t_s)});
  }
  return poses;
}

/// Between the knots a cubic spline is off by 5/384 h^4 of the fourth derivative (de Boor), which is pi^4
/// here.
TEST(SmoothPath, LiesBetweenItsKnotsAsSplinesDo) {
  const SmoothPath path(weave_at(20, 81));
  EXPECT_DOUBLE_EQ(path.length_s(), 4);
  const double bound = 5.0 / 384 * std::pow(0.05 * pi, 4);
  for (double t_s = 0; t_s <= 4; t_s += 0.003) {
    EXPECT_LT((path.at(t_s).translation() - weave(t_s).translation()).norm(), 1.1 * bound) << t_s;
    EXPECT_LT(apart_rad(path.at(t_s), weave(t_s)), 3 * bound) << t_s;
  }
}

TEST(SmoothPath, StraightAtConstantSpeedItStaysSo) {
  std::vector<TimedPose> poses(4);
  const Eigen::AngleAxisd nose_up(-0.19, Eigen::Vector3d::UnitY());
  const double times_s[] = {0, 0.2, 1.9, 2};
  for (std::size_t i = 0; i < 4; ++i)
    poses[i] = {std::llround(times_s[i] * 1e9), Eigen::Translation3d(12 * times_s[i] - 5, 1, 4.5) * nose_up};
  const SmoothPath path(poses);
  for (const double t_s : {-1e-4, 0.1, 0.7, 1.95, 2.0001}) {
    const Truth truth = carried_truth([&](double t) { return path.at(t); }, std::llround(t_s * 1e9), 9.81);
    EXPECT_NEAR(truth.T_world_body.translation().x(), 12 * t_s - 5, 1e-9);
    EXPECT_LT((truth.velocity_world_mps - Eigen::Vector3d(12, 0, 0)).norm(), 1e-8);
    EXPECT_LT(truth.angular_rate_body_radps.norm(), 1e-8);
    const Eigen::Vector3d at_rest = nose_up.inverse() * Eigen::Vector3d(0, 0, 9.81);
    EXPECT_LT((truth.specific_force_body_mps2 - at_rest).norm(), 1e-4);
  }
}

/// What the IMU is told of the shipped weave, integrated, is the weave.
TEST(SmoothPath, RatesAndForcesAreThePathsOwn) {
  const SmoothPath path(read_path(root / "scenarios/library/paths/banked.tum"));
  expect_felt_path(
      [&](std::int64_t t_ns) { return carried_truth([&](double t_s) { return path.at(t_s); }, t_ns, 9.81); },
      2e-3);
}

TEST_F(PathFile, AllFormsSayTheSame) {
  const fs::path tum = folder.write("a.tum", "0.5 1 2 3 0.5 -0.5 0.5 0.5\n1 2 2 3 0.5 -0.5 0.5 0.5\n");
  const fs::path flown =
      folder.write("trajectory.csv",
                   "t_s,x_m,y_m,z_m,qw,qx,qy,qz,vx_world_mps\n0.500000,1,2,3,0.5,0.5,-0.5,0.5,9\n\n"
                   "1.000000,2,2,3,0.5,0.5,-0.5,0.5,9\n");
  const auto a = read_path(tum), b = read_path(flown);
  ASSERT_EQ(a.size(), 2u);
  ASSERT_EQ(b.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a[i].t_ns, b[i].t_ns);
    EXPECT_TRUE(a[i].T_world_body.isApprox(b[i].T_world_body, 1e-12));
  }
}

TEST_F(PathFile, WhatNobodyCanBeCarriedAlongIsRefused) {
  const auto complaint = [&](const std::string& text) -> std::string {
    try {
      read_path(folder.write("path", text));
    } catch (const ScenarioError& error) {
      return error.what();
    }
    return "none";
  };
  const auto expect_complaint = [&](const std::string& text, const std::string& part) {
    support::expect_part(complaint(text), part);
    EXPECT_EQ(complaint(text).find('\n'), std::string::npos);
  };
  expect_complaint("", "holds no pose");
  expect_complaint("0 0 0 4 0 0 0 1\n", "needs at least two poses");
  expect_complaint("0 0 0 4 0 0 0 1\n0 1 0 4 0 0 0 1\n", "needs at least two poses");  // one moment, twice
  expect_complaint("1 0 0 4 0 0 0 1\n0 1 0 4 0 0 0 1\n", "path:2: times must increase");
  expect_complaint("0 0 0 4 0 0 0 1\n1 101 0 4 0 0 0 1\n", "path:2: must be at most 100 m/s");
  expect_complaint("0 0 0 4 0 0 0 1\n1 1 0 4 1 0 0 0\n", "must be at most a quarter turn");
  expect_complaint("t_s,x_m,y_m,z_m,qw,qx,qy,qz\n", "holds no pose");
  expect_complaint("t_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,4,1,0,0,0\n\n1,2,3\n",
                   "path:4: expected 8 cells, as line 1 has names, found 3");
  expect_complaint("t_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,4,1,0,0,0\n\n1,2,3,a,1,0,0,0\n",
                   "path:4: expected numbers under the columns' names");
}

TEST_F(PathFile, ThinningKeepsBothEndsAndADistance) {
  const auto thin = thinned(weave_at(200, 814));
  EXPECT_EQ(thin.front().t_ns, 7'000'000'000);
  EXPECT_EQ(thin.back().t_ns, 7'000'000'000 + 813 * std::int64_t{5'000'000});
  for (std::size_t i = 1; i < thin.size(); ++i) {
    EXPECT_GE(thin[i].t_ns - thin[i - 1].t_ns, 50'000'000);
    EXPECT_LT(thin[i].t_ns - thin[i - 1].t_ns, 100'000'000);
  }
  EXPECT_EQ(thinned(weave_at(1000, 2)).size(), 2u);
  EXPECT_EQ(thinned(weave_at(1, 5)).size(), 5u);
}

/// The shipped path says where it is: every recorded pose is known beforehand.
TEST_F(Follow, TheShippedPathIsWhereItSays) {
  const Scenario scenario = library_scenario("forest", {"seed=1003", "cameras.rate_hz=2"});
  const Carried carried =
      follow_recorded(scenario, read_path(root / "scenarios/library/paths/level.tum"), into(folder.path()));
  EXPECT_EQ(carried.frames, 14);
  EXPECT_NEAR(carried.carried_m, 80, 0.01);
  EXPECT_FALSE(fs::exists(folder.path() / "mav0/estimate0"));
  const Eigen::AngleAxisd nose_up(-10.97 / 180 * pi, Eigen::Vector3d::UnitY());
  for (const TimedPose& pose : read_poses(folder.path() / "mav0/state_groundtruth_estimate0/data.csv")) {
    const double t_s = static_cast<double>(pose.t_ns - recorded_ns(0)) * 1e-9;
    const Eigen::Isometry3d expected = Eigen::Translation3d(12 * t_s - 5, 0, 4.5) * nose_up;
    EXPECT_LT((pose.T_world_body.translation() - expected.translation()).norm(), 1e-5);
    EXPECT_LT(apart_rad(pose.T_world_body, expected), 1e-6);
  }
}

/// A flight's own path, followed, shows what the flight saw.
TEST_F(Follow, AFlightsTrajectoryLooksLikeTheFlight) {
  const Scenario scenario = library_scenario("forest", {"seed=1003", "cameras.rate_hz=10", "time_limit_s=3",
                                                        "forest.clear_m=8", "perception.detector=none"});
  const fs::path flown = folder.path() / "flown", followed = folder.path() / "followed";
  const FlownRecording flight = fly_recorded(scenario, into(flown));
  const Carried carried = follow_recorded(scenario, read_path(flown / "trajectory.csv"), into(followed));
  EXPECT_GE(carried.frames, flight.frames - 1);
  int compared = 0, alike = 0;
  for (const auto& entry : fs::directory_iterator(flown / "mav0/depth0/data")) {
    const fs::path other = followed / "mav0/depth0/data" / entry.path().filename();
    if (!fs::exists(other)) continue;  // of the last moment, after the last row of the trajectory
    const cv::Mat a = cv::imread(entry.path().string(), cv::IMREAD_UNCHANGED);
    const cv::Mat b = cv::imread(other.string(), cv::IMREAD_UNCHANGED);
    for (int row = 0; row < a.rows; ++row)
      for (int column = 0; column < a.cols; ++column) {
        const double here_mm = a.at<std::uint16_t>(row, column);
        if (here_mm == 0 || here_mm > 20'000) continue;
        ++compared;
        alike += std::abs(b.at<std::uint16_t>(row, column) - here_mm) < 0.02 * here_mm ? 1 : 0;
      }
  }
  EXPECT_GT(compared, 100'000);
  EXPECT_GT(alike, 0.98 * compared);  // the rest: outlines
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

TEST(Walk, WhatAnImuWouldFeelIsThePathsOwn) {
  const WalkPath path = path_of(library_scenario("forest", {"seed=1003"}));
  expect_felt_path([&](std::int64_t t_ns) { return walk_truth(path, t_ns); }, 1e-4);
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
  walk_recorded(scenario, {}, into(folder.path()));
  const StereoRig rig = read_calibrated_rig(folder.path(), {}).rig;
  const auto poses = read_poses(folder.path() / "mav0/state_groundtruth_estimate0/data.csv");
  const cv::Mat depth = image_of(folder.path(), "depth0", 0);
  const Eigen::Isometry3d T_world_camera = pose_at(poses, recorded_ns(0)).value() * rig.T_body_camera;
  int seen = 0, agreed = 0;
  for (int row = 0; row < rig.height_px; row += 2)
    for (int column = 0; column < rig.width_px; ++column) {
      const Eigen::Vector3d ray_world = T_world_camera.linear() * ray_of_pixel(rig, row, column);
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
  const RecordedWalk walk = walk_recorded(scenario, {1.4, 1.7}, into(folder.path()));
  EXPECT_EQ(walk.carried.frames, 5);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "mav0/estimate0"));

  const StereoRig rig = read_calibrated_rig(folder.path(), {}).rig;
  const auto poses = read_poses(folder.path() / "mav0/state_groundtruth_estimate0/data.csv");
  for (const std::int64_t t_ns : {0, 300'000'000}) {
    const cv::Mat depth = image_of(folder.path(), "depth0", t_ns);
    ASSERT_EQ(depth.type(), CV_16UC1);
    const Eigen::Isometry3d T_world_camera = pose_at(poses, recorded_ns(t_ns)).value() * rig.T_body_camera;
    for (int row = 170; row < rig.height_px; row += 10)
      for (int column = 3; column < rig.width_px; column += 31) {
        const double falls = -(T_world_camera.linear() * ray_of_pixel(rig, row, column)).z();
        const double expected_m = T_world_camera.translation().z() / falls;
        EXPECT_NEAR(depth.at<std::uint16_t>(row, column), 1000 * expected_m, 0.5 + 2e-4 * 1000 * expected_m)
            << row << ", " << column;
      }
    EXPECT_EQ(depth.at<std::uint16_t>(3, 100), 0);  // the sky
  }
}

}  // namespace
}  // namespace understory
