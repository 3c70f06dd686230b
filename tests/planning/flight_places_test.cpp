#include "planning/manoeuvre.hpp"

#include <gtest/gtest.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>

#include <cmath>
#include <random>

namespace understory {
namespace {

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
