#include "scenarios/tuning/objective.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace understory {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// More is better.
double gain(const Goal& goal, const Figures& figures) {
  return goal.maximize ? figures[goal.figure] : -figures[goal.figure];
}

/// Strictly increasing, -1 .. 1.
double squashed(double value) { return value / (1 + std::abs(value)); }

/// No worse anywhere and better somewhere; all to be minimised.
bool beats(const std::vector<double>& a, const std::vector<double>& b) {
  bool is_better = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] > b[i]) return false;
    is_better = is_better || a[i] < b[i];
  }
  return is_better;
}

/// Places of those that nobody beats, of equal ones the first. Empty costs take no part.
std::vector<std::size_t> unbeaten(const std::vector<std::vector<double>>& costs) {
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (costs[i].empty()) continue;
    const auto rules_out = [&](std::size_t other) {
      return beats(costs[other], costs[i]) || costs[other] == costs[i];
    };
    if (std::ranges::any_of(front, rules_out)) continue;
    std::erase_if(front, [&](std::size_t other) { return beats(costs[i], costs[other]); });
    front.push_back(i);
  }
  return front;
}

/// Of those in `front` the nearest to the ideal point.
std::size_t nearest_to_ideal(const std::vector<std::vector<double>>& costs,
                             const std::vector<std::size_t>& front) {
  const std::size_t dimensions = costs[front.front()].size();
  std::vector<double> minimum(dimensions, infinity), maximum(dimensions, -infinity);
  for (const std::size_t member : front)
    for (std::size_t i = 0; i < dimensions; ++i) {
      minimum[i] = std::min(minimum[i], costs[member][i]);
      maximum[i] = std::max(maximum[i], costs[member][i]);
    }
  const auto distance = [&](std::size_t member) {
    double sum = 0;
    for (std::size_t i = 0; i < dimensions; ++i) {
      const double range = maximum[i] - minimum[i];
      if (range > 0) sum += std::pow((costs[member][i] - minimum[i]) / range, 2);
    }
    return sum;
  };
  return *std::ranges::min_element(front, {}, distance);
}

}  // namespace

std::vector<std::size_t> figures_of(const Objective& objective) {
  std::vector<std::size_t> figures;
  for (const Goal& goal : objective.goals) figures.push_back(goal.figure);
  for (const Limit& limit : objective.limits)
    if (std::ranges::find(figures, limit.figure) == figures.end()) figures.push_back(limit.figure);
  return figures;
}

double violation(const Objective& objective, const Figures& figures) {
  if (figures.empty()) return infinity;
  for (const Goal& goal : objective.goals)
    if (!std::isfinite(figures[goal.figure])) return infinity;
  double sum = 0;
  for (const Limit& limit : objective.limits) {
    const double value = figures[limit.figure];
    if (!std::isfinite(value)) return infinity;
    sum += std::max(0.0, limit.at_least ? limit.bound - value : value - limit.bound);
  }
  return sum;
}

std::vector<double> fitness(const Objective& objective, const Figures& figures) {
  const double missed = violation(objective, figures);
  if (missed > 0)
    return std::vector<double>(objective.goals.size(), 1 + (std::isinf(missed) ? 1 : missed / (1 + missed)));
  std::vector<double> costs;
  for (const Goal& goal : objective.goals) costs.push_back(-squashed(gain(goal, figures)));
  // Smaller than any step between shares of fewer than a thousand flights.
  if (objective.tie_breaker && costs.size() == 1) {
    const double more = figures[*objective.tie_breaker];
    if (std::isfinite(more)) costs[0] -= 2e-4 * more;
  }
  return costs;
}

std::optional<std::size_t> best_of(const Objective& objective, const std::vector<Figures>& figures) {
  std::vector<std::vector<double>> costs;
  for (const Figures& some : figures) {
    costs.emplace_back();
    if (violation(objective, some) > 0) continue;
    if (objective.goals.size() == 1)
      costs.back() = fitness(objective, some);
    else
      for (const Goal& goal : objective.goals) costs.back().push_back(-gain(goal, some));
  }
  const std::vector<std::size_t> front = unbeaten(costs);
  if (front.empty()) return {};
  return nearest_to_ideal(costs, front);
}

std::vector<std::size_t> pareto_front(const Objective& objective, const std::vector<Figures>& figures) {
  std::vector<std::vector<double>> costs;
  for (const Figures& some : figures) {
    costs.emplace_back();
    if (std::isinf(violation(objective, some))) continue;
    for (const Goal& goal : objective.goals) costs.back().push_back(-gain(goal, some));
    for (const Limit& limit : objective.limits)
      costs.back().push_back(limit.at_least ? -some[limit.figure] : some[limit.figure]);
  }
  std::vector<std::size_t> front = unbeaten(costs);
  std::ranges::stable_sort(front, {}, [&](std::size_t member) { return costs[member].front(); });
  return front;
}

std::vector<std::size_t> thinned(const std::vector<std::size_t>& front, std::size_t count) {
  if (front.size() <= count) return front;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < count; ++i) kept.push_back(front[i * (front.size() - 1) / (count - 1)]);
  return kept;
}

}  // namespace understory
