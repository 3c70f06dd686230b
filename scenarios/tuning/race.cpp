#include "scenarios/tuning/race.hpp"

#include <algorithm>
#include <cmath>

namespace understory {
namespace {

constexpr double fewest_units = 6;  // fewer say nothing of their scatter
constexpr double clearly = 1.645;   // standard errors: wrong for one in twenty

std::vector<Counts> without(std::vector<Counts> units, std::size_t left_out) {
  units.erase(units.begin() + static_cast<std::ptrdiff_t>(left_out));
  return units;
}

}  // namespace

Figures Race::expected(const Trial& rival, const std::vector<Counts>& rivals_glance,
                       const std::vector<Counts>& glance) const {
  Figures figures = rival.figures;
  const Figures one = judge_.figures(glance), other = judge_.figures(rivals_glance);
  for (std::size_t i = 0; i < figures.size(); ++i) figures[i] += one[i] - other[i];
  return figures;
}

std::optional<Figures> Race::dropped(const std::vector<Counts>& glance) const {
  const auto units = static_cast<double>(glance.size());
  if (units < fewest_units) return {};
  for (const Trial& rival : rivals_) {
    const std::vector<Counts>& rivals_glance = glance_at_(rival);
    const Figures figures = expected(rival, rivals_glance, glance);
    const std::vector<double> costs = fitness(objective_, figures),
                              rivals_costs = fitness(objective_, rival.figures);
    std::vector<double> mean(costs.size(), 0), square(costs.size(), 0);
    for (std::size_t left_out = 0; left_out < glance.size(); ++left_out) {
      const std::vector<double> partial =
          fitness(objective_, expected(rival, without(rivals_glance, left_out), without(glance, left_out)));
      for (std::size_t i = 0; i < costs.size(); ++i) {
        mean[i] += partial[i] / units;
        square[i] += partial[i] * partial[i] / units;
      }
    }
    bool is_better = false, is_worse = false;
    for (std::size_t i = 0; i < costs.size(); ++i) {
      const double standard_error = std::sqrt((units - 1) * std::max(0.0, square[i] - mean[i] * mean[i]));
      is_better = is_better || costs[i] < rivals_costs[i];
      is_worse = is_worse || costs[i] > rivals_costs[i] + clearly * standard_error;
    }
    if (is_worse && !is_better) return figures;
  }
  return {};
}

void Race::add(const Trial& trial) {
  const double missed = violation(objective_, trial.figures);
  if (missed > 0) {
    if (keep_limits_ || (!rivals_.empty() && violation(objective_, rivals_[0].figures) <= missed)) return;
    rivals_.clear();
  } else if (!keep_limits_) {
    keep_limits_ = true;
    rivals_.clear();
  }
  rivals_.push_back(trial);
  std::vector<Figures> all;
  for (const Trial& rival : rivals_) all.push_back(rival.figures);
  std::vector<Trial> best;
  if (objective_.goals.size() == 1) {
    best.push_back(rivals_[best_of(objective_, all).value_or(0)]);
  } else {
    for (const std::size_t i : pareto_front(objective_, all)) best.push_back(rivals_[i]);
  }
  rivals_ = std::move(best);
}

}  // namespace understory
