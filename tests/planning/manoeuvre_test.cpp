#include "planning/manoeuvre.hpp"

#include <gtest/gtest.h>

#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <cmath>
#include <random>

#include "planning/manoeuvre_search.hpp"
#include "tests/planning/forests.hpp"

namespace understory {
namespace {

/// A task, and a search for a manoeuvre in it, whose parts live as long as it does.
struct SearchedFlight {
  explicit SearchedFlight(std::vector<Trunk> standing = {})
      : trunks(std::move(standing)), field(field_config, points_of(trunks), 0) {
    start.position_world.z() = mission.cruise_altitude_m;
  }
  FlightTask task() const { return {model, config, mission, field, start.position_world}; }
  std::optional<Manoeuvre> search(std::uint64_t seed, double maximum_cost = INFINITY) const {
    return search_manoeuvre(task(), start, {}, ManoeuvreSearchConfig{}, maximum_cost, seed, sst_tree);
  }
  double cost_of(const Manoeuvre& manoeuvre) const {
    return fly_out(task(), start, manoeuvre, config.minimum_clearance_m, false).cost;
  }

  FlightModel model{Airframe{}, FlightModelConfig{}};
  TrajectoryConfig config;
  Mission mission;
  ObstacleFieldConfig field_config;
  std::vector<Trunk> trunks;
  ObstacleField field;
  FlightState start;
};

TEST(FlyOut, ReachesTheHorizonInFreeSpace) {
  const SearchedFlight flight;
  const Rollout rollout = fly_out(flight.task(), flight.start, {}, 0.05, true);
  EXPECT_TRUE(rollout.reached_horizon);
  ASSERT_GE(rollout.points.size(), 3u);
  EXPECT_EQ(rollout.points.front().position_world, flight.start.position_world);
  EXPECT_GE(rollout.points.back().position_world.x(), flight.config.horizon_m);
  EXPECT_LT(rollout.points[rollout.points.size() - 2].position_world.x(), flight.config.horizon_m);
  for (std::size_t i = 0; i < rollout.points.size(); ++i)
    EXPECT_NEAR(rollout.points[i].t_s, flight.config.step_s * static_cast<double>(i), 1e-9);
  EXPECT_NEAR(rollout.free_until_s, rollout.points.back().t_s, 1e-6);
  EXPECT_NEAR(rollout.points.back().position_world.z(), flight.mission.cruise_altitude_m, 0.3);
}

TEST(FlyOut, StopsBeforeAnObstacle) {
  const SearchedFlight flight(wall(8));
  const double minimum_m = 0.2;
  const Rollout rollout = fly_out(flight.task(), flight.start, {}, minimum_m, true);
  EXPECT_FALSE(rollout.reached_horizon);
  EXPECT_LT(rollout.minimum_clearance_m, minimum_m);
  EXPECT_LT(rollout.points.back().position_world.x(), 8.0);
  EXPECT_LT(rollout.free_until_s, 8.0 / 11.0);
  // The manoeuvre is free at its last free moment.
  const PlanPoint& before = rollout.points[rollout.points.size() - 2];
  EXPECT_NEAR(before.t_s, rollout.free_until_s, 1e-9);
  EXPECT_LT(before.position_world.x(), 8.0 - minimum_m);
}

TEST(FlyOut, FliesThroughWhereToldTo) {
  const SearchedFlight flight(wall(8));
  const Rollout rollout = fly_out(flight.task(), flight.start, {}, 0.2, true, false);
  EXPECT_FALSE(rollout.reached_horizon);
  EXPECT_GE(rollout.points.back().position_world.x(), flight.config.horizon_m);
  EXPECT_LT(rollout.minimum_clearance_m, 0);
  EXPECT_LT(rollout.free_until_s, 8.0 / 11.0);
}

TEST(FlyOut, StopsWhereTheBandEnds) {
  SearchedFlight flight;
  flight.start.position_world.z() = flight.mission.maximum_altitude_m - 0.15;
  flight.start.climb_angle_rad = 0.15;
  const Rollout rollout = fly_out(flight.task(), flight.start, {{{0, 2}, 2.0}}, 0.05, true);
  EXPECT_FALSE(rollout.reached_horizon);
  EXPECT_LT(rollout.minimum_margin_m, 0.05);
  EXPECT_GE(rollout.minimum_clearance_m, flight.config.comfortable_clearance_m);  // no obstacle far and wide
  EXPECT_LT(rollout.points.back().position_world.x(), flight.config.horizon_m);
}

TEST(FlyOut, HoldsEachCommandForItsTime) {
  const SearchedFlight flight;
  const Manoeuvre manoeuvre{{{0.5, 0}, 0.2}, {{-0.4, 1}, 0.1}};
  const Rollout rollout = fly_out(flight.task(), flight.start, manoeuvre, 0.05, true);
  for (const PlanPoint& point : rollout.points) {
    if (point.t_s < 0.199) {
      EXPECT_EQ(point.bank_command_rad, 0.5);
    } else if (point.t_s < 0.299) {
      EXPECT_EQ(point.bank_command_rad, -0.4);
      EXPECT_EQ(point.climb_command_mps, 1);
    } else {
      EXPECT_NE(point.climb_command_mps, 1);
    }
  }
}

TEST(FlyOut, NearerObstaclesCostMore) {
  const SearchedFlight beside({{{8, 0.9}}}), clear;
  EXPECT_GT(fly_out(beside.task(), beside.start, {}, -1, false).cost,
            fly_out(clear.task(), clear.start, {}, -1, false).cost);
}

TEST(CourseCommand, TurnsBackToTheCourse) {
  SearchedFlight flight;
  EXPECT_NEAR(course_command(flight.task(), flight.start).bank_rad, 0, 1e-9);
  flight.start.heading_rad = 0.3;  // pointing left of the course: bank right
  EXPECT_GT(course_command(flight.task(), flight.start).bank_rad, 0.1);
  flight.start.heading_rad = 0;
  flight.start.position_world.y() = flight.mission.half_width_m - 1;  // at the left side: turn right, inwards
  EXPECT_GT(course_command(flight.task(), flight.start).bank_rad, 0.1);
  flight.start.position_world = {0, 0, flight.mission.cruise_altitude_m - 1};
  EXPECT_GT(course_command(flight.task(), flight.start).climb_mps, 0.1);
}

/// In a forest of its own.
SearchedFlight random_flight(std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::vector<Trunk> trunks = random_forest(generator, 8, 4, 13);
  trunks.push_back({{8, 0.2}});  // one right ahead
  SearchedFlight flight(std::move(trunks));
  flight.start.bank_rad = std::uniform_real_distribution<double>(-0.5, 0.5)(generator);
  flight.start.heading_rad = std::uniform_real_distribution<double>(-0.3, 0.3)(generator);
  return flight;
}

bool same(const std::optional<Manoeuvre>& one, const std::optional<Manoeuvre>& other) {
  if (!one || !other) return one.has_value() == other.has_value();
  return std::equal(one->begin(), one->end(), other->begin(), other->end(),
                    [](const ManoeuvrePart& a, const ManoeuvrePart& b) {
                      return a.command == b.command && a.duration_s == b.duration_s;
                    });
}

TEST(ManoeuvreSearch, FindsOnlyWhatCostsLessThanTheMaximum) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SearchedFlight flight = random_flight(seed);
    const std::optional<Manoeuvre> any = flight.search(seed);
    ASSERT_TRUE(any.has_value());
    const double cost = flight.cost_of(*any);
    const std::optional<Manoeuvre> again = flight.search(seed, 1.01 * cost);
    ASSERT_TRUE(again.has_value()) << "the same is there to be found";
    EXPECT_LT(flight.cost_of(*again), 1.01 * cost);
    const std::optional<Manoeuvre> cheaper = flight.search(seed, 0.9 * cost);
    EXPECT_LT(cheaper ? flight.cost_of(*cheaper) : 0, 0.9 * cost);
    EXPECT_FALSE(flight.search(seed, 0.5).has_value()) << "14 m take a second";
  }
}

// The bound by which rollouts are cut short: flights that end because of it would have cost too much.
TEST(FlyOut, CutShortByItsCostItWouldHaveCostMore) {
  int flights = 0, cut_short = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SearchedFlight flight = random_flight(seed);
    flight.start.wind_world_mps = {seed % 2 ? 3.0 : -3.0, 1};
    flight.start.climb_angle_rad = seed % 3 ? 0 : -0.4;  // a dive
    for (const Manoeuvre& manoeuvre : avoidance_primitives(1.5)) {
      const Rollout whole = fly_out(flight.task(), flight.start, manoeuvre, -INFINITY, false, false);
      if (!whole.reached_horizon) continue;
      const auto flown = [&](double maximum_cost) {
        return fly_out(flight.task(), flight.start, manoeuvre, -INFINITY, false, false, maximum_cost);
      };
      EXPECT_EQ(flown(1.001 * whole.cost).cost, whole.cost);
      cut_short += !flown(0.5 * whole.cost).reached_horizon;
      ++flights;
    }
  }
  EXPECT_GT(flights, 400);
  EXPECT_GT(cut_short, 0.95 * flights);  // a few pay most at their end
}

TEST(ManoeuvreSearch, RepeatsExactlyWhateverWasSearchedBefore) {
  const SearchedFlight flight({{{9, 0.1}}, {{11, 2.5}}, {{12, -2}}}), other = random_flight(2);
  const std::optional<Manoeuvre> first = flight.search(42);
  ASSERT_TRUE(first.has_value());
  EXPECT_TRUE(same(first, flight.search(42)));
  other.search(7);
  flight.search(43);
  EXPECT_TRUE(same(first, flight.search(42)));
  EXPECT_TRUE(same(first, SearchedFlight(flight.trunks).search(42)));  // all objects new
}

TEST(ManoeuvreSearch, SeedsDiffer) {
  const SearchedFlight flight({{{9, 0.1}}, {{11, 2.5}}, {{12, -2}}});
  int different = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    different += !same(flight.search(seed), flight.search(seed + 100));
  EXPECT_GE(different, 3);
}

TEST(ManoeuvreSearch, WhatItFindsKeepsClearOfEveryKnownTrunk) {
  int found_count = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const SearchedFlight flight = random_flight(seed);
    const std::optional<Manoeuvre> found = flight.search(seed);
    if (!found) continue;
    ++found_count;
    const double limit = flight.config.minimum_clearance_m;
    Plan plan;
    const Rollout rollout = fly_out(flight.task(), flight.start, *found, limit, true);
    EXPECT_TRUE(rollout.reached_horizon) << "seed " << seed;
    plan.points = rollout.points;
    const ObstacleFieldConfig& field = flight.field_config;
    const double around_m = field.wing_radius_m + field.sigma_zero_m + 0.5 * field.cell_m;
    EXPECT_GE(plan_distance_m(plan, flight.trunks, field), around_m + limit - 1e-9) << "seed " << seed;
    for (const PlanPoint& point : plan.points) {
      EXPECT_GT(point.position_world.z(), flight.mission.minimum_altitude_m);
      EXPECT_LT(point.position_world.z(), flight.mission.maximum_altitude_m);
    }
  }
  EXPECT_GE(found_count, 45);
}

TEST(ManoeuvreSearch, FindsNothingThroughAWall) {
  const SearchedFlight flight(wall(8));
  for (std::uint64_t seed = 1; seed <= 5; ++seed) EXPECT_FALSE(flight.search(seed).has_value());
}

TEST(ManoeuvreSearch, FindsTheDoorInAWall) {
  std::vector<Trunk> trunks = wall(9);
  std::erase_if(trunks,
                [](const Trunk& trunk) { return trunk.foot_world.y() > 0.2 && trunk.foot_world.y() < 3.5; });
  const SearchedFlight flight(std::move(trunks));
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) found += flight.search(seed).has_value();
  EXPECT_GE(found, 4);
}

/// Coarse steps, so that many places are equally far.
FlightPlace random_place(std::mt19937_64& generator) {
  const auto step = [&] { return static_cast<double>(generator() % 7) * 0.25; };
  return {{step(), step(), step()}, 0.3 * step(), 0.8 * step()};
}

TEST(FlightPlaces, AnswerAsOmplsLinearSearchDoes) {
  std::mt19937_64 generator(3);
  for (int trial = 0; trial < 40; ++trial) {
    FlightPlaces places;
    std::vector<FlightPlace> all;
    ompl::NearestNeighborsLinear<int> plain;  // numbers; the last is the place asked about
    plain.setDistanceFunction([&](int one, int other) {
      return std::sqrt(
          squared_distance(all[static_cast<std::size_t>(one)], all[static_cast<std::size_t>(other)]));
    });
    const int count = 1 + static_cast<int>(generator() % 200);
    for (int i = 0; i < count; ++i) {
      all.push_back(random_place(generator));
      places.add(all.back());
      plain.add(i);
    }
    const auto asked = static_cast<int>(all.size());
    all.push_back(random_place(generator));
    const FlightPlace place = all.back();
    EXPECT_EQ(static_cast<int>(places.nearest(place)), plain.nearest(asked));
    std::vector<int> expected;
    const auto equals = [&](const std::vector<std::size_t>& numbers) {
      return std::equal(numbers.begin(), numbers.end(), expected.begin(), expected.end(),
                        [](std::size_t one, int other) { return static_cast<int>(one) == other; });
    };
    for (const std::size_t k : {std::size_t{1}, std::size_t{6}, std::size_t{500}}) {
      plain.nearestK(asked, k, expected);
      EXPECT_TRUE(equals(places.nearest(place, k))) << k;
    }
    for (const double radius : {0.0, 0.5, 0.6, 3.0}) {
      plain.nearestR(asked, radius, expected);
      EXPECT_TRUE(equals(places.within(place, radius))) << radius;
    }
  }
}

TEST(FlightPlaces, ARemovedPlaceIsGoneAndLaterOnesMoveUp) {
  FlightPlaces places;
  for (const double x : {0.0, 1.0, 2.0}) places.add({{x, 0, 0}, 0, 0});
  places.remove(1);
  EXPECT_EQ(places.size(), 2u);
  EXPECT_EQ(places.nearest({{1.9, 0, 0}, 0, 0}), 1u);
  EXPECT_EQ(places.nearest({{0.9, 0, 0}, 0, 0}), 0u);
}

}  // namespace
}  // namespace understory
