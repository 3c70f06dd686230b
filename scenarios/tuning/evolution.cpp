#include <algorithm>
#include <cmath>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "scenarios/config/named_seed.hpp"
#include "scenarios/tuning/search.hpp"

namespace understory {
namespace {

/// Ends an evolution that has used up its trials.
struct TrialsSpent {};

/// Every parameter's share of its range: a cube of edge 1. The library copies it, and makes it from nothing.
struct CubeProblem {
  const Space* space = nullptr;
  const Objective* objective = nullptr;
  const Evaluate* evaluate = nullptr;
  int* trials_left = nullptr;

  pagmo::vector_double fitness(const pagmo::vector_double& shares) const {
    if ((*trials_left)-- <= 0) throw TrialsSpent{};
    Point point;
    for (std::size_t i = 0; i < shares.size(); ++i)
      point.push_back(value_at(space->parameters[i], shares[i]));
    return understory::fitness(*objective, (*evaluate)(point));
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(space->parameters.size(), 0),
            pagmo::vector_double(space->parameters.size(), 1)};
  }
  pagmo::vector_double::size_type get_nobj() const { return objective->goals.size(); }
};

unsigned seed_of(const SearchConfig& config, std::string_view name, std::uint64_t start = 0) {
  return static_cast<unsigned>(seed_for(config.seed + start, name));
}

}  // namespace

void search_by_cma_es(const Space& space, const Objective& objective, const SearchConfig& config,
                      const Evaluate& evaluate) {
  int trials_left = config.trials;
  const pagmo::problem cube(CubeProblem{&space, &objective, &evaluate, &trials_left});
  // Hansen's default of 4 + 3 ln n; the library wants 5 at least.
  auto size = static_cast<std::size_t>(
      std::max(5.0, 4 + std::floor(3 * std::log(static_cast<double>(cube.get_nx())))));
  try {
    for (std::uint64_t start = 0;; ++start, size *= 2) {  // each start takes at least `size` trials
      const pagmo::cmaes method(static_cast<unsigned>(config.trials), -1, -1, -1, -1,
                                0.3,         // of the range: Hansen's advice for a first step
                                1e-7, 1e-4,  // converged: fitnesses the same, steps below any use
                                false, true, seed_of(config, "cma_es", start));
      method.evolve(pagmo::population(cube, size, seed_of(config, "start", start)));
    }
  } catch (const TrialsSpent&) {
  }
}

void search_by_nsga2(const Space& space, const Objective& objective, const SearchConfig& config,
                     const Evaluate& evaluate) {
  int trials_left = config.trials;
  const pagmo::problem cube(CubeProblem{&space, &objective, &evaluate, &trials_left});
  // As many generations as members; the library wants multiples of 4, from 8.
  const double root = std::sqrt(static_cast<double>(config.trials));
  const auto size = 4 * std::max<std::size_t>(2, static_cast<std::size_t>(root / 4));
  // Crossover, mutation and their distribution indices as Deb et al. 2002 have them.
  const pagmo::nsga2 method(static_cast<unsigned>(config.trials), 0.9, 20,
                            1.0 / static_cast<double>(cube.get_nx()), 20, seed_of(config, "nsga2"));
  try {
    method.evolve(pagmo::population(cube, size, seed_of(config, "start")));
  } catch (const TrialsSpent&) {
  }
}

}  // namespace understory
