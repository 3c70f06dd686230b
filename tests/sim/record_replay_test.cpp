#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "sim/aircraft/aircraft.hpp"

// The real aircraft against the simulated one, open loop: tests/data/flight/left_jog.csv (2015-10-08).
namespace understory {
namespace {

using Eigen::Vector3d;

struct Recorded {
  double t_s;
  Vector3d position_world;
  double roll_rad;
  Eigen::Matrix3d R_world_body;
  Vector3d velocity_body_mps;
  Controls controls;
};

std::vector<Recorded> left_jog() {
  std::ifstream stream(UNDERSTORY_SOURCE_DIR "/tests/data/flight/left_jog.csv");
  std::vector<Recorded> rows;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line[0] == '#' || line[0] == 't') continue;
    std::istringstream cells(line);
    std::array<double, 13> n{};
    char comma = 0;
    for (double& number : n) cells >> number >> comma;
    const Eigen::Matrix3d attitude =
        (Eigen::AngleAxisd(n[6], Vector3d::UnitZ()) * Eigen::AngleAxisd(n[5], Vector3d::UnitY()) *
         Eigen::AngleAxisd(n[4], Vector3d::UnitX()))
            .toRotationMatrix();
    rows.push_back({n[0], {n[1], n[2], n[3]}, n[4], attitude, {n[7], n[8], n[9]}, {n[10], n[11], n[12]}});
  }
  return rows;
}

/// The recorded rates are faulty: fit rate and angular acceleration to the attitude's turn over the first
/// samples.
Vector3d starting_rate(const std::vector<Recorded>& rows) {
  constexpr int samples = 10;
  Eigen::Matrix<double, samples, 2> times;
  Eigen::Matrix<double, samples, 3> turns;
  for (int i = 0; i < samples; ++i) {
    const Recorded& row = rows[static_cast<std::size_t>(i + 1)];
    times.row(i) << row.t_s, row.t_s * row.t_s;
    const Eigen::AngleAxisd turn(rows[0].R_world_body.transpose() * row.R_world_body);
    turns.row(i) = (turn.angle() * turn.axis()).transpose();
  }
  return (times.colPivHouseholderQr().solve(turns)).row(0).transpose();
}

double roll_of(const Eigen::Matrix3d& R_world_body) {
  return std::atan2(R_world_body(2, 1), R_world_body(2, 2));
}

/// Height gained by the record's own velocities: its z contradicts them.
double climbed_by_velocity_m(const std::vector<Recorded>& rows, double until_s) {
  double climbed = 0;
  for (std::size_t i = 1; i < rows.size() && rows[i].t_s <= until_s + 1e-9; ++i) {
    const double before = (rows[i - 1].R_world_body * rows[i - 1].velocity_body_mps).z();
    const double after = (rows[i].R_world_body * rows[i].velocity_body_mps).z();
    climbed += 0.5 * (before + after) * (rows[i].t_s - rows[i - 1].t_s);
  }
  return climbed;
}

TEST(RecordReplay, SimulatedJogFollowsTheRealOne) {
  const std::vector<Recorded> rows = left_jog();
  ASSERT_EQ(rows.size(), 151u);

  const Airframe airframe;
  const World world = build_world(UNDERSTORY_SOURCE_DIR "/models", airframe, {}, WorldConfig{});
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  constexpr double altitude_m = 50;
  Eigen::Isometry3d pose(rows[0].R_world_body);
  pose.translation() = Vector3d(0, 0, altitude_m);
  aircraft.place(pose, rows[0].R_world_body * rows[0].velocity_body_mps, starting_rate(rows),
                 rows[0].controls);

  struct Mark {
    std::size_t row;
    double horizontal_m;
    double roll_deg;
  };
  // Twice the error that the identification reached at 0.25, 0.5, 1.0 and 1.5 s (flight records): 0.12, 0.19,
  // 0.26, 0.39 m; and for roll 3, 2, -8, 4 deg, each taken as at most 10.
  const std::array<Mark, 4> marks = {{{25, 0.24, 10}, {50, 0.38, 10}, {100, 0.52, 16}, {150, 0.78, 10}}};
  std::size_t mark = 0;
  for (std::size_t row = 0; row + 1 < rows.size(); ++row) {
    for (int step = 0; step < 12; ++step) aircraft.step(rows[row].controls);
    if (mark >= marks.size() || row + 1 != marks[mark].row) continue;
    const Recorded& real = rows[row + 1];
    const Truth& truth = aircraft.truth();
    const double horizontal = (truth.T_world_body.translation() - real.position_world).head<2>().norm();
    const double roll_deg = (roll_of(truth.T_world_body.linear()) - real.roll_rad) * 180 / std::numbers::pi;
    const double climbed = truth.T_world_body.translation().z() - altitude_m;
    const double height = climbed - climbed_by_velocity_m(rows, real.t_s);
    std::ostringstream figures;
    figures << real.t_s << " s: " << horizontal << " m, roll " << roll_deg << " deg, height " << height
            << " m";
    RecordProperty("mark_" + std::to_string(mark), figures.str());
    EXPECT_LT(horizontal, marks[mark].horizontal_m) << "at " << real.t_s << " s";
    EXPECT_LT(std::abs(roll_deg), marks[mark].roll_deg) << "at " << real.t_s << " s";
    EXPECT_LT(std::abs(height), 1.0) << "at " << real.t_s << " s";
    ++mark;
  }
  EXPECT_EQ(mark, marks.size());
}

TEST(RecordReplay, RecordIsTheManoeuvreItSays) {
  const std::vector<Recorded> rows = left_jog();
  ASSERT_FALSE(rows.empty());
  EXPECT_NEAR(rows.back().position_world.x(), 16.7, 0.05);
  EXPECT_NEAR(rows.back().position_world.y(), 6.1, 0.05);
  double maximum_roll = 0;
  for (const Recorded& row : rows) maximum_roll = std::max(maximum_roll, std::abs(row.roll_rad));
  EXPECT_NEAR(maximum_roll * 180 / std::numbers::pi, 64, 2);
}

}  // namespace
}  // namespace understory
