#include "planning/obstacle_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/planning/forests.hpp"
#include "tests/support/instruction_sets.hpp"

namespace understory {
namespace {

/// Column by column, walking along the wing.
double clearance_by_walking_m(const ObstacleField& field, const ObstacleFieldConfig& config,
                              const FlightState& state, double maximum_m) {
  double minimum = maximum_m;
  const Eigen::Vector3d left =
      left_wing_by_rotations(state.heading_rad, state.climb_angle_rad, state.bank_rad);
  for (const ObstacleField::Column& column : field.columns()) {
    if ((column.centre_world - state.position_world.head<2>()).norm() > maximum_m + 2) continue;
    const double wing = wing_distance_by_walking_m(state.position_world, left, config.half_span_m,
                                                   column.centre_world, column.bottom_m, column.top_m);
    minimum = std::min(minimum, wing - column.radius_m - config.wing_radius_m);
  }
  return minimum;
}

TEST(ObstacleField, ClearanceAgreesWithWalkingAlongTheWing) {
  std::mt19937_64 generator(11);
  const auto uniform = [&](double minimum, double maximum) {
    return std::uniform_real_distribution<double>(minimum, maximum)(generator);
  };
  ObstacleFieldConfig config;
  int near = 0, touching = 0;
  for (int trial = 0; trial < 60; ++trial) {
    config.trunk_m = trial % 3;
    std::vector<ObstaclePoint> points;  // scattered at every height, some in short stacks
    for (int i = 0; i < 40; ++i) {
      ObstaclePoint point;
      point.position_world = {uniform(-8, 8), uniform(-8, 8), uniform(0, 7)};
      point.distance_flown_m = uniform(0, 50);
      points.push_back(point);
      point.position_world.z() += uniform(0, 2);
      points.push_back(point);
    }
    const ObstacleField field(config, points, 50);
    for (int pose = 0; pose < 20; ++pose) {
      FlightState state;
      state.position_world = {uniform(-9, 9), uniform(-9, 9), uniform(0, 7)};
      state.heading_rad = uniform(-3.1, 3.1);
      state.climb_angle_rad = uniform(-0.5, 0.5);
      state.bank_rad = uniform(-1.6, 1.6);
      const double expected = clearance_by_walking_m(field, config, state, 2.0);
      EXPECT_NEAR(field.clearance_m(state, 2.0), expected, 5e-4);
      near += expected < 1.0;
      touching += expected < 0;
    }
  }
  EXPECT_GT(near, 100);  // the random draw covered the near range
  EXPECT_GT(touching, 10);
}

/// To the bit: what is excluded by bounds in single precision decides nothing. Each point has a cell of its
/// own; some lie so far away that cells are compared and not counted.
TEST(ObstacleField, ClearanceOfManyColumnsIsTheLeastOfEachAlone) {
  std::mt19937_64 generator(12);
  const auto uniform = [&](double minimum, double maximum) {
    return std::uniform_real_distribution<double>(minimum, maximum)(generator);
  };
  const ObstacleFieldConfig config;
  int near = 0;
  for (const double apart_m : {0.0, 3000.0}) {
    std::vector<ObstaclePoint> points;
    std::vector<ObstacleField> alone;
    for (int i = 0; i < 1200; ++i) {
      ObstaclePoint& point = points.emplace_back();
      point.position_world = {100 + 0.3 * (i % 30) + uniform(0.01, 0.14),
                              0.3 * (i / 30) + uniform(0.01, 0.14), uniform(1, 7)};
      if (i % 2 == 0) point.position_world.x() += apart_m;
      point.distance_flown_m = uniform(0, 50);
    }
    for (const ObstaclePoint& point : points) alone.emplace_back(config, std::vector{point}, 50);
    const ObstacleField field(config, points, 50);
    ASSERT_EQ(field.columns().size(), points.size());
    for (int pose = 0; pose < 100; ++pose) {
      FlightState state;
      state.position_world = {100 + apart_m * (pose % 2) + uniform(-2, 11), uniform(-2, 14), uniform(0, 8)};
      state.heading_rad = uniform(-3.1, 3.1);
      state.bank_rad = uniform(-1.6, 1.6);
      double least = 2;
      for (const ObstacleField& one : alone) least = std::min(least, one.clearance_m(state, 2));
      support::on_every_instruction_set(
          [&](const std::string& target) { EXPECT_EQ(field.clearance_m(state, 2), least) << target; });
      near += least < 0.5;
    }
  }
  EXPECT_GT(near, 100);
}

TEST(ObstacleField, EveryPointStandsInAColumn) {
  std::mt19937_64 generator(2);
  std::uniform_real_distribution<double> place(-5, 5);
  const ObstacleFieldConfig config;
  std::vector<ObstaclePoint> points(300);
  for (ObstaclePoint& point : points)
    point.position_world = {place(generator), place(generator), place(generator)};
  const ObstacleField field(config, points, 0);
  for (const ObstaclePoint& point : points) {
    const bool stands = std::any_of(field.columns().begin(), field.columns().end(), [&](const auto& column) {
      return (column.centre_world - point.position_world.head<2>()).norm() <=
                 std::sqrt(2.0) * config.cell_m &&
             column.bottom_m <= point.position_world.z() && column.top_m >= point.position_world.z();
    });
    EXPECT_TRUE(stands);
  }
}

TEST(ObstacleField, ABankedWingPassesWhereALevelOneDoesNot) {
  const ObstacleFieldConfig config;
  // A gap of 0.9 m between the trunks' axes: the span alone is 0.86 m.
  const ObstacleField field(config, points_of({{{5, 0.45}}, {{5, -0.45}}}), 0);
  FlightState state;
  state.position_world = {5, 0, 4};
  EXPECT_LT(field.clearance_m(state, 3), 0);
  state.bank_rad = M_PI / 2;
  const double expected = 0.45 - config.wing_radius_m - config.sigma_zero_m - 0.5 * config.cell_m;
  EXPECT_NEAR(field.clearance_m(state, 3), expected, 1e-9);
  EXPECT_GT(field.clearance_m(state, 3), 0);
}

TEST(ObstacleField, WhatIsSeenOverTheHeightOfATrunkGoesOnUpAndDown) {
  ObstacleFieldConfig config;
  config.trunk_m = 1;
  std::vector<ObstaclePoint> points(2);
  points[0].position_world = {5, 0, 2};
  const auto clearance_m = [&](double top_m, double flight_m) {
    points[1].position_world = {5, 0, top_m};
    FlightState state;
    state.position_world = {5, 0, flight_m};
    return ObstacleField(config, points, 0).clearance_m(state, 3);
  };
  for (const double flight_m : {0.5, 6.0}) {
    EXPECT_GT(clearance_m(2.9, flight_m), 0.5);
    EXPECT_LT(clearance_m(3.1, flight_m), 0);
    EXPECT_GT(clearance_m(3.3, flight_m), 0.5) << "a gap of column_gap_m parts what is seen";
  }
}

TEST(ObstacleField, UncertaintyGrowsWithTheDistanceFlownUpToItsLimit) {
  ObstacleFieldConfig config;
  config.sigma_zero_m = 0.05, config.sigma_per_m = 0.01, config.sigma_maximum_m = 0.3;
  const std::vector<ObstaclePoint> points = points_of({{{5, 0.1}}});
  FlightState state;
  state.position_world = {3, 0, 4};
  const auto after = [&](double flown_m) {
    return ObstacleField(config, points, flown_m).clearance_m(state, 3);
  };
  const double fresh = after(0);
  EXPECT_NEAR(after(10), fresh - 0.10, 1e-9);
  EXPECT_NEAR(after(20), fresh - 0.20, 1e-9);
  EXPECT_NEAR(after(25), fresh - 0.25, 1e-9);  // 0.30 in all: the limit
  EXPECT_NEAR(after(500), fresh - 0.25, 1e-9);
}

TEST(ObstacleField, FreeSpaceAnswersTheGreatestAskedFor) {
  const ObstacleField empty({}, {}, 0);
  EXPECT_TRUE(empty.columns().empty());
  EXPECT_EQ(empty.clearance_m({}, 3), 3);
  const ObstacleField far({}, points_of({{{100, 0}}}), 0);
  EXPECT_EQ(far.clearance_m({}, 3), 3);
}

TEST(ObstacleField, OrderOfThePointsDoesNotMatter) {
  std::mt19937_64 generator(4);
  std::vector<ObstaclePoint> points = points_of(random_forest(generator, 30, 0, 12));
  const ObstacleField one({}, points, 0);
  std::shuffle(points.begin(), points.end(), generator);
  const ObstacleField other({}, points, 0);
  ASSERT_EQ(one.columns().size(), other.columns().size());
  for (double x = 0; x < 12; x += 0.25) {
    FlightState state;
    state.position_world = {x, 0.3, 4};
    EXPECT_EQ(one.clearance_m(state, 3), other.clearance_m(state, 3));
  }
}

}  // namespace
}  // namespace understory
