#include "planning/manoeuvre.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/planning/forests.hpp"

namespace understory {
namespace {

/// Everything that a search is asked with, in a forest of its own.
struct Search {
  explicit Search(std::vector<Trunk> standing)
      : trunks(std::move(standing)), field(field_config, points_of(trunks), 0) {
    start.position_world.z() = mission.cruise_altitude_m;
  }
  FlightTask task() const { return {model, trajectory, mission, field, start.position_world}; }
  std::optional<Manoeuvre> run(std::uint64_t seed) const {
    return search_manoeuvre(task(), start, {}, config, seed);
  }

  FlightModel model{Airframe{}, FlightModelConfig{}};
  TrajectoryConfig trajectory;
  Mission mission;
  ManoeuvreSearchConfig config;
  ObstacleFieldConfig field_config;
  std::vector<Trunk> trunks;
  ObstacleField field;
  FlightState start;
};

Search random_search(std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::vector<Trunk> trunks = random_forest(generator, 8, 4, 13);
  trunks.push_back({{8, 0.2}});  // one right ahead
  Search search(std::move(trunks));
  search.start.bank_rad = std::uniform_real_distribution<double>(-0.5, 0.5)(generator);
  search.start.heading_rad = std::uniform_real_distribution<double>(-0.3, 0.3)(generator);
  return search;
}

bool same(const std::optional<Manoeuvre>& one, const std::optional<Manoeuvre>& other) {
  if (!one || !other) return one.has_value() == other.has_value();
  return std::equal(one->begin(), one->end(), other->begin(), other->end(),
                    [](const ManoeuvrePart& a, const ManoeuvrePart& b) {
                      return a.command == b.command && a.duration_s == b.duration_s;
                    });
}

TEST(ManoeuvreSearch, RepeatsExactlyWhateverWasSearchedBefore) {
  const Search search({{{9, 0.1}}, {{11, 2.5}}, {{12, -2}}}), other = random_search(2);
  const std::optional<Manoeuvre> first = search.run(42);
  ASSERT_TRUE(first.has_value());
  EXPECT_TRUE(same(first, search.run(42)));
  other.run(7);
  search.run(43);
  EXPECT_TRUE(same(first, search.run(42)));
  EXPECT_TRUE(same(first, Search(search.trunks).run(42)));  // all objects new
}

TEST(ManoeuvreSearch, SeedsDiffer) {
  const Search search({{{9, 0.1}}, {{11, 2.5}}, {{12, -2}}});
  int different = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    different += !same(search.run(seed), search.run(seed + 100));
  EXPECT_GE(different, 3);
}

TEST(ManoeuvreSearch, WhatItFindsKeepsClearOfEveryKnownTrunk) {
  int found_count = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Search search = random_search(seed);
    const std::optional<Manoeuvre> found = search.run(seed);
    if (!found) continue;
    ++found_count;
    const double limit = search.trajectory.minimum_clearance_m;
    Plan plan;
    const Rollout rollout = fly_out(search.task(), search.start, *found, limit, true);
    EXPECT_TRUE(rollout.reached_horizon) << "seed " << seed;
    plan.points = rollout.points;
    const ObstacleFieldConfig& field = search.field_config;
    const double around_m = field.wing_radius_m + field.sigma_zero_m + 0.5 * field.cell_m;
    EXPECT_GE(plan_distance_m(plan, search.trunks, field), around_m + limit - 1e-9) << "seed " << seed;
    for (const PlanPoint& point : plan.points) {
      EXPECT_GT(point.position_world.z(), search.mission.minimum_altitude_m);
      EXPECT_LT(point.position_world.z(), search.mission.maximum_altitude_m);
    }
  }
  EXPECT_GE(found_count, 45);
}

TEST(ManoeuvreSearch, FindsNothingThroughAWall) {
  const Search search(wall(8));
  for (std::uint64_t seed = 1; seed <= 5; ++seed) EXPECT_FALSE(search.run(seed).has_value());
}

TEST(ManoeuvreSearch, FindsTheDoorInAWall) {
  std::vector<Trunk> trunks = wall(9);
  std::erase_if(trunks,
                [](const Trunk& trunk) { return trunk.foot_world.y() > 0.2 && trunk.foot_world.y() < 3.5; });
  const Search search(std::move(trunks));
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) found += search.run(seed).has_value();
  EXPECT_GE(found, 4);
}

}  // namespace
}  // namespace understory
