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
using Objects = support::FolderTest;

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

struct ObjectAgreement {
  int compared = 0, agreed = 0, on_obstacles = 0;
};

/// Where a pixel's neighbours are of one object: outlines are drawn with flat sides.
ObjectAgreement compare(const cv::Mat& found, const cv::Mat& expected) {
  ObjectAgreement agreement;
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
  ObjectAgreement agreement;
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
    const ObjectAgreement one =
        compare(found, expected_objects(recorded.objects, rig, pose_at(poses, t_ns).value()));
    recorded.agreement.compared += one.compared;
    recorded.agreement.agreed += one.agreed;
    recorded.agreement.on_obstacles += one.on_obstacles;
  }
  return recorded;
}

TEST_F(Objects, OfEveryCourseAreThoseThatRaysMeet) {
  struct Course {
    std::string name;
    std::vector<std::string> settings, kinds;  ///< kinds of the objects behind sky and ground, the first ones
    int smallest_on_obstacles;
  };
  for (const Course& course :
       {Course{
            "forest", {"cameras.view_distance_m=200", "forest.square_metres_per_tree=20"}, {"trunk"}, 20'000},
        Course{"goalposts", {"goalposts.ahead_m=17"}, {"post", "post", "crossbar"}, 500},
        Course{"fence", {"fence.first_across_m=16", "forest.length_m=15"}, {"post"}, 500},
        Course{"windows", {"forest.length_m=5"}, {"wall"}, 100'000}}) {
    SCOPED_TRACE(course.name);
    const Recorded found = walked(course.name, course.settings, folder.path() / course.name);
    ASSERT_GE(found.objects.size(), 2 + course.kinds.size());
    EXPECT_EQ(found.objects[1].kind, "ground");
    for (std::size_t i = 0; i < course.kinds.size(); ++i)
      EXPECT_EQ(found.objects[2 + i].kind, course.kinds[i]);
    EXPECT_EQ(found.objects.back().kind == "rail", course.name == "fence");
    EXPECT_GT(found.agreement.on_obstacles, course.smallest_on_obstacles);
    EXPECT_EQ(found.agreement.agreed, found.agreement.compared);
  }
}

/// Flown straight at, a wall is a plane whose depth is one distance less the way gone.
TEST_F(Objects, AWallAheadHasOneDepth) {
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
TEST_F(Objects, AlongTheBankedPathAreThoseThatRaysMeet) {
  const Scenario scenario =
      library_scenario("forest", {"seed=1003", "cameras.rate_hz=2", "cameras.view_distance_m=200"});
  EXPECT_EQ(
      follow_recorded(scenario, read_path(root / "scenarios/library/paths/banked.tum"), into(folder.path()))
          .frames,
      14);
  const StereoRig rig = read_calibrated_rig(folder.path(), {}).rig;
  const auto objects = read_objects(folder.path() / "mav0/objects0/objects.csv");
  constexpr double degree = std::numbers::pi / 180;
  ObjectAgreement all;
  for (int i = 0; i < 14; ++i) {
    const double roll_rad = 50 * degree * std::sin(std::numbers::pi * 0.5 * i);
    Eigen::Isometry3d pose(Eigen::Translation3d(6 * i - 5, 0, 4.5));
    pose.linear() = (Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX()) *
                     Eigen::AngleAxisd(-10.97 * degree, Eigen::Vector3d::UnitY()))
                        .toRotationMatrix();
    const cv::Mat found = image_of(folder.path(), "objects0", i * std::int64_t{500'000'000});
    const ObjectAgreement one = compare(found, expected_objects(objects, rig, pose));
    all.compared += one.compared, all.agreed += one.agreed, all.on_obstacles += one.on_obstacles;
  }
  EXPECT_GT(all.on_obstacles, 50'000);
  EXPECT_EQ(all.agreed, all.compared);
}

/// What is not drawn is no object: neither image nor depth nor number knows of it.
TEST_F(Objects, BeyondTheViewAreNone) {
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
