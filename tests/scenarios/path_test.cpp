#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "perception/io/text_table.hpp"
#include "scenarios/recording/carried_path.hpp"
#include "scenarios/recording/euroc_texts.hpp"
#include "scenarios/recording/record.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "tests/support/temporary_folder.hpp"

/// Paths that cameras are carried along, and what they leave.
namespace understory {
namespace {

namespace fs = std::filesystem;
using support::TemporaryFolder;

const fs::path root = UNDERSTORY_SOURCE_DIR;
constexpr double pi = std::numbers::pi;

Scenario library_scenario(const std::string& name, const std::vector<std::string>& settings) {
  return load_scenario(root / "scenarios/library" / (name + ".yaml"), settings);
}

FlyOptions into(const fs::path& folder) {
  FlyOptions options;
  options.models_folder = root / "models";
  options.output_folder = folder;
  return options;
}

double apart_rad(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
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
  const SmoothPath path(read_path(root / "scenarios/paths/banked.tum"));
  const auto truth_at = [&](std::int64_t t_ns) {
    return carried_truth([&](double t_s) { return path.at(t_s); }, t_ns, 9.81);
  };
  const Truth start = truth_at(0);
  Eigen::Quaterniond q(start.T_world_body.linear());
  Eigen::Vector3d v = start.velocity_world_mps, p = start.T_world_body.translation();
  const double h_s = 0.0005;
  const auto turned_by = [](const Eigen::Vector3d& rotation) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
  };
  for (int i = 0; i < 6000; ++i) {
    const Truth middle = truth_at(i * std::int64_t{500'000} + 250'000);
    const Eigen::Quaterniond q_middle = q * turned_by(0.5 * h_s * middle.angular_rate_body_radps);
    const Eigen::Vector3d a = q_middle * middle.specific_force_body_mps2 - Eigen::Vector3d(0, 0, 9.81);
    p += h_s * v + 0.5 * h_s * h_s * a;
    v += h_s * a;
    q = q * turned_by(h_s * middle.angular_rate_body_radps);
  }
  const Truth end = truth_at(3'000'000'000);
  EXPECT_LT((p - end.T_world_body.translation()).norm(), 2e-3);
  EXPECT_LT((v - end.velocity_world_mps).norm(), 2e-3);
  EXPECT_LT(q.angularDistance(Eigen::Quaterniond(end.T_world_body.linear())), 1e-5);
}

TEST(PathFile, AllFormsSayTheSame) {
  const TemporaryFolder folder;
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

TEST(PathFile, WhatNobodyCanBeCarriedAlongIsRefused) {
  const TemporaryFolder folder;
  const auto complaint = [&](const std::string& text) -> std::string {
    try {
      read_path(folder.write("path", text));
    } catch (const ScenarioError& error) {
      return error.what();
    }
    return "none";
  };
  const auto expect_complaint = [&](const std::string& text, const std::string& part) {
    EXPECT_NE(complaint(text).find(part), std::string::npos) << complaint(text);
    EXPECT_EQ(complaint(text).find('\n'), std::string::npos);
  };
  expect_complaint("", "expected at least one pose");
  expect_complaint("0 0 0 4 0 0 0 1\n", "expected at least two poses");
  expect_complaint("0 0 0 4 0 0 0 1\n0 1 0 4 0 0 0 1\n", "path:2: expected times that increase");
  expect_complaint("0 0 0 4 0 0 0 1\n1 101 0 4 0 0 0 1\n", "expected at most 100 m/s from pose 1");
  expect_complaint("0 0 0 4 0 0 0 1\n1 1 0 4 1 0 0 0\n", "expected at most a quarter turn");
  expect_complaint("t_s,x_m,y_m,z_m,qw,qx,qy,qz\n", "expected at least one pose");
  expect_complaint("t_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,4,1,0,0,0\n\n1,2,3\n", "path:4: expected t_s,x_m");
  expect_complaint("t_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,4,1,0,0,0\n\n1,2,3,a,1,0,0,0\n", "path:4: expected");
}

TEST(PathFile, ThinningKeepsBothEndsAndADistance) {
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
TEST(Follow, TheShippedPathIsWhereItSays) {
  const TemporaryFolder folder;
  const Scenario scenario = library_scenario("forest", {"seed=1003", "cameras.rate_hz=2"});
  const Carried carried =
      follow_recorded(scenario, read_path(root / "scenarios/paths/level.tum"), into(folder.path()));
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
TEST(Follow, AFlightsTrajectoryLooksLikeTheFlight) {
  const TemporaryFolder folder;
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

}  // namespace
}  // namespace understory
