#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "perception/io/pose_file.hpp"
#include "scenarios/parts/oracles.hpp"
#include "scenarios/recording/carried_path.hpp"
#include "scenarios/recording/record.hpp"
#include "scenarios/scenario/scenario_rig.hpp"
#include "tests/scenarios/recordings.hpp"
#include "tests/support/temporary_folder.hpp"

/// The recorded images of objects, read back, against rays sent at the course.
namespace understory {
namespace {

namespace fs = std::filesystem;

/// A line of objects.csv.
struct Object {
  std::string name, kind;
  Eigen::Vector3d from_world = Eigen::Vector3d::Zero(), to_world = Eigen::Vector3d::Zero();
  double radius_m = 0;
};

/// Their places are their numbers; 0 is nothing.
std::vector<Object> read_objects(const fs::path& file) {
  std::istringstream lines(support::content_of(file));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line + "\n", objects_header);
  std::vector<Object> objects(1);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::array<std::string, 10> cell;
    for (std::string& text : cell) std::getline(cells, text, ',');
    EXPECT_EQ(cell[0], std::to_string(objects.size()));
    const auto vector = [&](std::size_t at) {
      return Eigen::Vector3d(std::stod(cell[at]), std::stod(cell[at + 1]), std::stod(cell[at + 2]));
    };
    objects.push_back({cell[1], cell[2], vector(3), vector(6), std::stod(cell[9])});
  }
  return objects;
}

/// Side or end of a bar: rails show theirs at a gate.
double ray_meets_closed_bar(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray, const Object& bar) {
  double nearest = ray_meets_round_obstacle(eye, ray, bar.from_world, bar.to_world, bar.radius_m);
  const Eigen::Vector3d axis = (bar.to_world - bar.from_world).normalized();
  for (const Eigen::Vector3d& end : {bar.from_world, bar.to_world}) {
    const double reach = (end - eye).dot(axis) / ray.dot(axis);
    if (reach > 0 && (eye + reach * ray - end).norm() < bar.radius_m) nearest = std::min(nearest, reach);
  }
  return nearest;
}

Obstacle as_wall(const Object& object) {
  return {object.name, object.from_world, object.to_world, object.radius_m, 0, 0, ObstacleKind::wall};
}

/// What a ray of the left camera meets first, by the file's own geometry.
cv::Mat expected_objects(const std::vector<Object>& objects, const StereoRig& rig,
                         const Eigen::Isometry3d& T_world_body) {
  const Eigen::Isometry3d T_world_camera = T_world_body * rig.T_body_camera;
  const Eigen::Vector3d eye = T_world_camera.translation();
  cv::Mat expected(rig.height_px, rig.width_px, CV_16UC1);
  for (int row = 0; row < rig.height_px; ++row)
    for (int column = 0; column < rig.width_px; ++column) {
      const Eigen::Vector3d ray = T_world_camera.linear() * ray_of_pixel(rig, row, column);
      std::size_t first = 0;
      double nearest = std::numeric_limits<double>::infinity();
      const double to_ground = -eye.z() / ray.z();
      const Eigen::Vector2d at = (eye + to_ground * ray).head<2>();
      if (to_ground > 0 && at.cwiseAbs().maxCoeff() < 400) nearest = to_ground, first = 1;  // its rim
      for (std::size_t i = 2; i < objects.size(); ++i) {
        const Object& object = objects[i];
        const double reach = object.kind == "wall" ? ray_meets_wall(eye, ray, as_wall(object))
                                                   : ray_meets_closed_bar(eye, ray, object);
        if (reach < nearest) nearest = reach, first = i;
      }
      expected.at<std::uint16_t>(row, column) = static_cast<std::uint16_t>(first);
    }
  return expected;
}

struct Agreement {
  int compared = 0, agreed = 0, on_obstacles = 0;
};

/// Where a pixel's neighbours are of one object: outlines are drawn with flat sides.
Agreement compare(const cv::Mat& found, const cv::Mat& expected) {
  Agreement agreement;
  for (int row = 2; row + 2 < found.rows; ++row)
    for (int column = 2; column + 2 < found.cols; ++column) {
      const std::uint16_t here = expected.at<std::uint16_t>(row, column);
      const cv::Mat around = expected(cv::Rect(column - 2, row - 2, 5, 5));
      if (cv::countNonZero(around != here) > 0) continue;
      ++agreement.compared;
      agreement.agreed += found.at<std::uint16_t>(row, column) == here ? 1 : 0;
      agreement.on_obstacles += here >= 2 ? 1 : 0;
    }
  return agreement;
}

struct Recorded {
  std::vector<Object> objects;
  Agreement agreement;
};

/// A second of walking, compared frame by frame.
Recorded walked(const std::string& name, std::vector<std::string> settings, const fs::path& folder) {
  settings.insert(settings.end(), {"seed=1003", "time_limit_s=1", "cameras.rate_hz=4"});
  const Scenario scenario = library_scenario(name, settings);
  walk_recorded(scenario, {}, into(folder));
  Recorded recorded{read_objects(folder / "mav0/objects0/objects.csv"), {}};
  EXPECT_EQ(recorded.objects.size(), 2 + course_obstacles(scenario).size());
  EXPECT_EQ(support::content_of(folder / "mav0/objects0/data.csv"),
            support::content_of(folder / "mav0/cam0/data.csv"));
  const StereoRig rig = read_calibrated_rig(folder, {}).rig;
  const auto poses = read_poses(folder / "mav0/state_groundtruth_estimate0/data.csv");
  for (const auto& entry : fs::directory_iterator(folder / "mav0/objects0/data")) {
    const cv::Mat found = cv::imread(entry.path().string(), cv::IMREAD_UNCHANGED);
    EXPECT_EQ(found.type(), CV_16UC1);
    const std::int64_t t_ns = std::stoll(entry.path().stem().string());
    const Agreement one =
        compare(found, expected_objects(recorded.objects, rig, pose_at(poses, t_ns).value()));
    recorded.agreement.compared += one.compared;
    recorded.agreement.agreed += one.agreed;
    recorded.agreement.on_obstacles += one.on_obstacles;
  }
  return recorded;
}

TEST(Objects, OfAForestAreThoseThatRaysMeet) {
  const support::TemporaryFolder folder;
  const Recorded forest =
      walked("forest", {"cameras.view_distance_m=200", "forest.square_metres_per_tree=20"}, folder.path());
  EXPECT_EQ(forest.objects[1].kind, "ground");
  EXPECT_EQ(forest.objects[2].kind, "trunk");
  EXPECT_GT(forest.agreement.on_obstacles, 20'000);
  EXPECT_EQ(forest.agreement.agreed, forest.agreement.compared);
}

TEST(Objects, OfAGoalAreThoseThatRaysMeet) {
  const support::TemporaryFolder folder;
  const Recorded goal = walked("goalposts", {"goalposts.ahead_m=17"}, folder.path());
  ASSERT_EQ(goal.objects.size(), 5u);
  EXPECT_EQ(goal.objects[2].kind, "post");
  EXPECT_EQ(goal.objects[4].name, "crossbar");
  EXPECT_EQ(goal.objects[4].kind, "crossbar");
  EXPECT_GT(goal.agreement.on_obstacles, 500);
  EXPECT_EQ(goal.agreement.agreed, goal.agreement.compared);
}

TEST(Objects, OfAFenceAreThoseThatRaysMeet) {
  const support::TemporaryFolder folder;
  const Recorded fence = walked("fence", {"fence.first_across_m=16", "forest.length_m=15"}, folder.path());
  EXPECT_EQ(fence.objects[2].kind, "post");
  EXPECT_EQ(fence.objects.back().kind, "rail");
  EXPECT_GT(fence.agreement.on_obstacles, 500);
  EXPECT_EQ(fence.agreement.agreed, fence.agreement.compared);
}

TEST(Objects, OfAWallOfWindowsAreThoseThatRaysMeet) {
  const support::TemporaryFolder folder;
  const Recorded facade = walked("windows", {"forest.length_m=5"}, folder.path());
  ASSERT_EQ(facade.objects.size(), 3u);
  EXPECT_EQ(facade.objects[2].name, "facade");
  EXPECT_EQ(facade.objects[2].kind, "wall");
  EXPECT_GT(facade.agreement.on_obstacles, 100'000);
  EXPECT_EQ(facade.agreement.agreed, facade.agreement.compared);
}

/// Flown straight at, a wall is a plane whose depth is one distance less the way gone.
TEST(Objects, AWallAheadHasOneDepth) {
  const support::TemporaryFolder folder;
  const fs::path knots = folder.write(
      "straight", "0 0 0 4.5 0 -0.095585155 0 0.995421257\n1 12 0 4.5 0 -0.095585155 0 0.995421257\n");
  const fs::path followed = folder.path() / "followed";
  follow_recorded(library_scenario("windows", {"cameras.rate_hz=4"}), read_path(knots), into(followed));
  const Eigen::Vector3d camera_body = read_calibrated_rig(followed, {}).rig.T_body_camera.translation();
  const double nose_up_rad = 10.97 / 180 * std::numbers::pi;
  const double ahead_m = camera_body.x() * std::cos(nose_up_rad) - camera_body.z() * std::sin(nose_up_rad);
  for (const int quarter : {3, 4}) {  // before, 65.535 m do not reach
    const cv::Mat depth = image_of(followed, "depth0", quarter * std::int64_t{250'000'000});
    const cv::Mat objects = image_of(followed, "objects0", quarter * std::int64_t{250'000'000});
    double minimum = 0, maximum = 0;
    cv::minMaxLoc(depth, &minimum, &maximum, nullptr, nullptr, objects == 2);
    EXPECT_GT(cv::countNonZero(objects == 2), 20'000);
    const double expected_mm = 1000 * (72 - 3.0 * quarter - ahead_m);
    EXPECT_NEAR(minimum, expected_mm, 0.5 + 2e-4 * expected_mm);
    EXPECT_NEAR(maximum, expected_mm, 0.5 + 2e-4 * expected_mm);
  }
}

/// Along the banked path, which goes through trunks: where it is at a time is known, and its roll.
TEST(Objects, AlongTheBankedPathAreThoseThatRaysMeet) {
  const support::TemporaryFolder folder;
  const Scenario scenario =
      library_scenario("forest", {"seed=1003", "cameras.rate_hz=2", "cameras.view_distance_m=200"});
  EXPECT_EQ(
      follow_recorded(scenario, read_path(root / "scenarios/library/paths/banked.tum"), into(folder.path()))
          .frames,
      14);
  const StereoRig rig = read_calibrated_rig(folder.path(), {}).rig;
  const auto objects = read_objects(folder.path() / "mav0/objects0/objects.csv");
  constexpr double degree = std::numbers::pi / 180;
  Agreement all;
  for (int i = 0; i < 14; ++i) {
    const double roll_rad = 50 * degree * std::sin(std::numbers::pi * 0.5 * i);
    Eigen::Isometry3d pose(Eigen::Translation3d(6 * i - 5, 0, 4.5));
    pose.linear() = (Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX()) *
                     Eigen::AngleAxisd(-10.97 * degree, Eigen::Vector3d::UnitY()))
                        .toRotationMatrix();
    const cv::Mat found = image_of(folder.path(), "objects0", i * std::int64_t{500'000'000});
    const Agreement one = compare(found, expected_objects(objects, rig, pose));
    all.compared += one.compared, all.agreed += one.agreed, all.on_obstacles += one.on_obstacles;
  }
  EXPECT_GT(all.on_obstacles, 50'000);
  EXPECT_EQ(all.agreed, all.compared);
}

/// What is not drawn is no object: neither image nor depth nor number knows of it.
TEST(Objects, BeyondTheViewAreNone) {
  const support::TemporaryFolder folder;
  const Recorded forest = walked("forest", {"cameras.view_distance_m=5"}, folder.path());
  for (const auto& entry : fs::directory_iterator(folder.path() / "mav0/objects0/data")) {
    double maximum = 0;
    cv::minMaxLoc(cv::imread(entry.path().string(), cv::IMREAD_UNCHANGED), nullptr, &maximum);
    EXPECT_EQ(maximum, object_ground);
  }
  EXPECT_GT(forest.agreement.on_obstacles, 0);  // although some stand there
}

}  // namespace
}  // namespace understory
