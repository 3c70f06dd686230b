#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scenarios/tuning/search.hpp"

/// Searches of functions whose optima are known.
namespace understory {
namespace {

Parameter range(const std::string& key, double from, double to, bool logarithmic = false) {
  Parameter parameter{key};
  parameter.from = from;
  parameter.to = to;
  parameter.logarithmic = logarithmic;
  return parameter;
}

Space plane() { return {{range("a.x", -2, 3), range("a.y", -1, 4)}}; }

struct Found {
  std::vector<Point> points;
  std::vector<Figures> figures;
};

template <typename Function>
Found search_all(const Space& space, const Objective& objective, const SearchConfig& config,
                 Function&& function) {
  Found found;
  search(space, objective, config, [&](const Point& point) {
    found.points.push_back(point);
    found.figures.push_back(function(point));
    return found.figures.back();
  });
  return found;
}

/// Minimum 0 at (0.7, 1.9).
Figures sphere(const Point& p) { return {std::pow(p[0] - 0.7, 2) + std::pow(p[1] - 1.9, 2)}; }

const Objective minimum_first{{{0, false}}};

TEST(Search, EveryMethodFindsTheSpheresCentre) {
  const struct {
    SearchMethod method;
    int trials;
    double within;
  } cases[] = {{SearchMethod::random, 2000, 0.2}, {SearchMethod::cma_es, 400, 0.002}};
  for (const auto& one : cases) {
    const Found found = search_all(plane(), minimum_first, {one.method, one.trials, 3}, sphere);
    EXPECT_EQ(found.points.size(), static_cast<std::size_t>(one.trials));
    const Point& best = found.points[best_of(minimum_first, found.figures).value()];
    EXPECT_NEAR(best[0], 0.7, one.within);
    EXPECT_NEAR(best[1], 1.9, one.within);
  }
}

TEST(Search, StartsAnewInAFunctionOfManyHollows) {
  // Rastrigin's function in two dimensions, its centre at (1, 1): about a hundred local minima.
  const auto rastrigin = [](const Point& p) {
    double sum = 0;
    for (const double x : p) sum += 10 + std::pow(x - 1, 2) - 10 * std::cos(2 * M_PI * (x - 1));
    return Figures{sum};
  };
  const Space space{{range("x", -5, 5), range("y", -5, 5)}};
  const Found found = search_all(space, minimum_first, {SearchMethod::cma_es, 6000, 1}, rastrigin);
  EXPECT_EQ(found.points.size(), 6000u);
  EXPECT_LT(found.figures[best_of(minimum_first, found.figures).value()][0],
            0.5);  // other minima: 1 and more
}

TEST(Search, GivesTheSamePointsForTheSameSeedAndOthersForAnother) {
  const Objective both{{{0, false}, {1, false}}};
  const auto two = [](const Point& p) { return Figures{sphere(p)[0], std::abs(p[0])}; };
  for (const SearchMethod method : {SearchMethod::random, SearchMethod::cma_es, SearchMethod::nsga2}) {
    const Objective& objective = method == SearchMethod::nsga2 ? both : minimum_first;
    const Found once = search_all(plane(), objective, {method, 100, 5}, two);
    const Found again = search_all(plane(), objective, {method, 100, 5}, two);
    const Found other = search_all(plane(), objective, {method, 100, 6}, two);
    EXPECT_EQ(once.points, again.points);
    EXPECT_NE(once.points, other.points);
  }
}

TEST(Search, KeepsToALimit) {
  // Greatest x + y on the unit disc: at (1, 1) / sqrt 2.
  const auto function = [](const Point& p) { return Figures{p[0] + p[1], std::hypot(p[0], p[1])}; };
  const Objective objective{{{0, true}}, {{1, false, 1.0}}};
  const Found found = search_all(plane(), objective, {SearchMethod::cma_es, 3000, 2}, function);
  const std::size_t best = best_of(objective, found.figures).value();
  EXPECT_LE(found.figures[best][1], 1);
  EXPECT_NEAR(found.figures[best][0], std::sqrt(2.0), 0.01);
}

TEST(Search, Nsga2FindsTheFrontOfSchaffersProblem) {
  // Schaffer 1985: x^2 and (x - 2)^2; the front is x from 0 to 2, on which sqrt f1 + sqrt f2 = 2.
  const auto function = [](const Point& p) { return Figures{p[0] * p[0], std::pow(p[0] - 2, 2)}; };
  const Objective objective{{{0, false}, {1, false}}};
  const Space space{{range("x", -10, 10)}};
  const Found found = search_all(space, objective, {SearchMethod::nsga2, 1000, 1}, function);
  EXPECT_EQ(found.points.size(), 1000u);
  const std::vector<std::size_t> front = pareto_front(objective, found.figures);
  ASSERT_GT(front.size(), 30u);
  std::set<int> tenths;
  for (const std::size_t member : front) {
    const double x = found.points[member][0];
    EXPECT_GE(x, -0.05);
    EXPECT_LE(x, 2.05);
    EXPECT_NEAR(std::sqrt(found.figures[member][0]) + std::sqrt(found.figures[member][1]), 2, 0.1);
    tenths.insert(static_cast<int>(x * 5));
  }
  EXPECT_GE(tenths.size(), 9u);  // spread over all of it
}

TEST(Search, Nsga2FindsTheFrontOfZdt1) {
  // Zitzler, Deb & Thiele 2000: the front is f2 = 1 - sqrt f1, where all but the first parameter are 0.
  const auto function = [](const Point& p) {
    double g = 1;
    for (std::size_t i = 1; i < p.size(); ++i) g += 9 * p[i] / static_cast<double>(p.size() - 1);
    return Figures{p[0], g * (1 - std::sqrt(p[0] / g))};
  };
  Space space;
  for (int i = 0; i < 5; ++i) space.parameters.push_back(range("x", 0, 1));
  const Objective objective{{{0, false}, {1, false}}};
  const Found found = search_all(space, objective, {SearchMethod::nsga2, 6000, 1}, function);
  double maximum_miss = 0;
  for (const std::size_t member : pareto_front(objective, found.figures))
    maximum_miss = std::max(maximum_miss, found.figures[member][1] - 1 + std::sqrt(found.figures[member][0]));
  EXPECT_LT(maximum_miss, 0.1);
}

TEST(Search, AGridIsEveryCombinationOnce) {
  Parameter list{"b.n"};
  list.values = {1, 4, 9};
  Parameter three = range("a.x", 0, 1);
  three.steps = 3;
  Parameter decades = range("a.z", 0.01, 100, true);
  decades.steps = 5;
  const Space space{{list, three, decades}};
  EXPECT_EQ(grid_size(space), 45u);
  const Found found = search_all(space, minimum_first, {SearchMethod::grid, 45, 1}, sphere);
  ASSERT_EQ(found.points.size(), 45u);
  EXPECT_EQ(std::set<Point>(found.points.begin(), found.points.end()).size(), 45u);
  EXPECT_EQ(found.points.front(), (Point{1, 0, 0.01}));
  EXPECT_EQ(found.points[1], (Point{1, 0, 0.1}));
  EXPECT_EQ(found.points[7], (Point{1, 0.5, 1}));
  EXPECT_EQ(found.points.back(), (Point{9, 1, 100}));
}

TEST(Space, WholeNumbersStayWholeAndAreEquallyLikely) {
  Parameter whole = range("n", 3, 6);
  whole.whole = true;
  std::vector<int> counts(7);
  for (int i = 0; i < 400; ++i) {
    const double value = value_at(whole, (i + 0.5) / 400);
    EXPECT_EQ(value, std::round(value));
    ++counts.at(static_cast<std::size_t>(value));
  }
  EXPECT_EQ(counts, (std::vector<int>{0, 0, 0, 100, 100, 100, 100}));
  EXPECT_EQ(value_at(whole, 0), 3);
  EXPECT_EQ(value_at(whole, 1), 6);
  EXPECT_EQ(spread_values(whole, 9), (std::vector<double>{3, 4, 5, 6}));
}

TEST(Space, ALogarithmicRangeHasAsMuchToEveryFactor) {
  const Parameter scale = range("s", 0.05, 0.4, true);
  EXPECT_NEAR(value_at(scale, 1.0 / 3), 0.1, 1e-6);
  EXPECT_NEAR(value_at(scale, 2.0 / 3), 0.2, 1e-6);
  EXPECT_EQ(value_at(scale, 0), 0.05);
  EXPECT_EQ(value_at(scale, 1.5), 0.4);  // beyond its end: the end
}

TEST(Space, WritesAPointInGroupsAndListsWhole) {
  Space space{{range("p.rule.score", 0, 1), range("top", 0, 1), range("p.depths[1]", 0, 99),
               range("p.rule.edge", 0, 1)}};
  space.lists["p.depths"] = {4.8, 10, 15};
  EXPECT_EQ(to_yaml(space, {0.25, 1, 12.5, 0.5}),
            "p:\n  depths: [4.8, 12.5, 15]\n  rule:\n    edge: 0.5\n    score: 0.25\ntop: 1\n");
}

TEST(Objective, WhatKeepsTheLimitsComesFirstWhateverTheGoalSays) {
  const Objective objective{{{0, true}}, {{1, true, 0.9}}};
  const auto cost = [&](double goal, double limited) { return fitness(objective, {goal, limited})[0]; };
  EXPECT_LT(cost(0.1, 0.9), cost(1e6, 0.899));
  EXPECT_LT(cost(0.2, 0.95), cost(0.1, 0.99));
  EXPECT_LT(cost(0.0, 0.8), cost(1.0, 0.7));
  EXPECT_LT(cost(-1e6, 0.9), cost(0.5, 0.8));
  EXPECT_LT(cost(0, 0), fitness(objective, {})[0]);  // refused
  EXPECT_LT(cost(0, 0), cost(1, std::nan("")));
  EXPECT_FALSE(best_of(objective, {{1, 0.5}, {}}));
}

TEST(Objective, ATieIsBrokenByProgressAndOnlyATie) {
  Objective objective{{{0, true}}};
  objective.tie_breaker = 1;
  EXPECT_EQ(best_of(objective, {{0.5, 0.6}, {0.5, 0.7}, {0.49, 1.0}}), 1u);
  for (int goals = 0; goals < 999; ++goals)  // of 1000 flights
    EXPECT_GT(fitness(objective, {goals / 1000.0, 1})[0], fitness(objective, {(goals + 1) / 1000.0, 0})[0]);
}

TEST(Objective, TheFrontHoldsWhatNothingBeats) {
  const Objective objective{{{0, true}, {1, false}}};
  const std::vector<Figures> figures{{3, 3}, {1, 1}, {2, 2.5}, {2, 2}, {3, 4}, {1, 1}, {}, {std::nan(""), 0}};
  EXPECT_EQ(pareto_front(objective, figures), (std::vector<std::size_t>{0, 3, 1}));
  EXPECT_EQ(thinned({1, 2, 3, 4, 5, 6, 7}, 3), (std::vector<std::size_t>{1, 4, 7}));
  // Several goals: the member nearest to the best of each, here (0.5, 0.5) of the way.
  EXPECT_EQ(best_of(objective, figures), 3u);
}

TEST(Objective, ALimitIsASideOfTheFront) {
  const Objective objective{{{0, true}}, {{1, true, 0.97}}};
  EXPECT_EQ(pareto_front(objective, {{0.9, 0.5}, {0.6, 0.98}, {0.5, 0.97}, {0.7, 0.97}}),
            (std::vector<std::size_t>{0, 3, 1}));
  EXPECT_EQ(best_of(objective, {{0.9, 0.5}, {0.6, 0.98}, {0.5, 0.97}, {0.7, 0.97}}), 3u);
}

}  // namespace
}  // namespace understory
