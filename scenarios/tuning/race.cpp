#include "scenarios/tuning/race.hpp"

#include <algorithm>
#include <cmath>

namespace understory {
namespace {

/// How much higher a figure of one is than that of another.
struct Difference {
  double value = 0, standard_error = 0;
};

std::vector<Counts> without(std::vector<Counts> units, std::size_t left_out) {
  units.erase(units.begin() + static_cast<std::ptrdiff_t>(left_out));
  return units;
}

/// Of every figure, by the jackknife over units.
std::vector<Difference> differences(const Judge& judge, const std::vector<Counts>& one,
                                    const std::vector<Counts>& other) {
  const auto difference = [&](const std::vector<Counts>& a, const std::vector<Counts>& b) {
    Figures values = judge.figures(a);
    const Figures subtrahend = judge.figures(b);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] -= subtrahend[i];
    return values;
  };
  const std::size_t units = one.size();
  std::vector<Difference> result;
  for (const double value : difference(one, other)) result.push_back({value, HUGE_VAL});
  if (units < 2) return result;
  std::vector<Figures> partial;
  for (std::size_t i = 0; i < units; ++i) partial.push_back(difference(without(one, i), without(other, i)));
  const auto count = static_cast<double>(units);
  for (std::size_t figure = 0; figure < result.size(); ++figure) {
    double mean = 0, square = 0;
    for (const Figures& values : partial) mean += values[figure] / count;
    for (const Figures& values : partial) square += std::pow(values[figure] - mean, 2);
    result[figure].standard_error = std::sqrt(square * (count - 1) / count);
  }
  return result;
}

}  // namespace

bool Race::loses_to(const std::vector<Counts>& rival, const std::vector<Counts>& glance) const {
  const std::vector<Difference> gained = differences(judge_, glance, rival);
  const Figures figures = judge_.figures(glance);
  const auto gain = [&](std::size_t figure, bool more_is_better) {
    return more_is_better ? gained[figure].value : -gained[figure].value;
  };
  const auto is_clearly_worse = [&](std::size_t figure, bool more_is_better) {
    return gain(figure, more_is_better) < -2 * gained[figure].standard_error;
  };
  for (const Limit& limit : objective_.limits) {
    const bool is_missed =
        limit.at_least ? figures[limit.figure] < limit.bound : figures[limit.figure] > limit.bound;
    if (is_missed && is_clearly_worse(limit.figure, limit.at_least)) return true;
  }
  return keep_limits_ &&
         std::ranges::all_of(objective_.goals,
                             [&](const Goal& goal) { return gain(goal.figure, goal.maximize) <= 0; }) &&
         std::ranges::any_of(objective_.goals,
                             [&](const Goal& goal) { return is_clearly_worse(goal.figure, goal.maximize); });
}

std::optional<Figures> Race::dropped(const std::vector<Counts>& glance) const {
  for (const Trial& rival : rivals_) {
    const std::vector<Counts>& rivals_glance = glance_at_(rival);
    if (!loses_to(rivals_glance, glance)) continue;
    Figures figures = rival.figures;
    const Figures one = judge_.figures(glance), other = judge_.figures(rivals_glance);
    for (std::size_t i = 0; i < figures.size(); ++i) figures[i] += one[i] - other[i];
    return figures;
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
