#include "scenarios/tuning/search.hpp"

#include <random>

namespace understory {
namespace {

std::vector<std::vector<double>> grid_axes(const Space& space) {
  std::vector<std::vector<double>> axes;
  for (const Parameter& parameter : space.parameters)
    axes.push_back(spread_values(parameter, parameter.steps));
  return axes;
}

/// The last parameter changes first.
void search_grid(const Space& space, const Evaluate& evaluate) {
  const std::vector<std::vector<double>> axes = grid_axes(space);
  for (std::size_t number = 0; number < grid_size(space); ++number) {
    Point point(axes.size());
    std::size_t rest = number;
    for (std::size_t i = axes.size(); i-- > 0; rest /= axes[i].size())
      point[i] = axes[i][rest % axes[i].size()];
    evaluate(point);
  }
}

void search_at_random(const Space& space, const SearchConfig& config, const Evaluate& evaluate) {
  std::mt19937_64 generator(config.seed);
  for (int trial = 0; trial < config.trials; ++trial) {
    Point point;
    for (const Parameter& parameter : space.parameters)  // 53 bits: 0 .. 1, the same with every library
      point.push_back(value_at(parameter, static_cast<double>(generator() >> 11) * 0x1p-53));
    evaluate(point);
  }
}

}  // namespace

std::size_t grid_size(const Space& space) {
  std::size_t size = 1;
  for (const std::vector<double>& axis : grid_axes(space)) size *= axis.size();
  return size;
}

void search(const Space& space, const Objective& objective, const SearchConfig& config,
            const Evaluate& evaluate) {
  switch (config.method) {
    case SearchMethod::random:
      return search_at_random(space, config, evaluate);
    case SearchMethod::grid:
      return search_grid(space, evaluate);
    case SearchMethod::cma_es:
      return search_by_cma_es(space, objective, config, evaluate);
    case SearchMethod::nsga2:
      return search_by_nsga2(space, objective, config, evaluate);
  }
}

}  // namespace understory
