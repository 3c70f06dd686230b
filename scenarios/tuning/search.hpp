#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>
#include <utility>

#include "scenarios/tuning/objective.hpp"
#include "scenarios/tuning/space.hpp"

namespace understory {

enum class SearchMethod {
  random,  ///< every parameter drawn evenly over its range, on its scale
  grid,    ///< every combination of the parameters' values or steps
  cma_es,  ///< covariance matrix adaptation (Hansen 2006), begun anew with twice the population when it has
           ///< converged (Auger & Hansen 2005); one goal
  nsga2    ///< Deb et al. 2002, IEEE Trans. Evol. Comput. 6(2); two goals or more
};
inline constexpr std::array<std::pair<std::string_view, SearchMethod>, 4> search_method_names{
    {{"random", SearchMethod::random},
     {"grid", SearchMethod::grid},
     {"cma_es", SearchMethod::cma_es},
     {"nsga2", SearchMethod::nsga2}}};

struct SearchConfig {
  SearchMethod method = SearchMethod::random;
  int trials = 0;  ///< of a grid: as many as it has
  std::uint64_t seed = 1;
  int sensitivity_points = 9;  ///< afterwards, of each parameter alone over its range; 2 .. 1000
};

/// Measures one point. Whatever it throws ends the search and comes out of it.
using Evaluate = std::function<Figures(const Point&)>;

/// Calls `evaluate` `trials` times, one point after the other. The sequence of points depends on nothing but
/// the arguments and what `evaluate` gave, so that a search can be repeated from a log of its figures.
void search(const Space& space, const Objective& objective, const SearchConfig& config,
            const Evaluate& evaluate);

/// Points of a grid: as many as it has.
std::size_t grid_size(const Space& space);

/// The two methods of the library (pagmo): in a file of their own, whose headers compile slowly.
void search_by_cma_es(const Space& space, const Objective& objective, const SearchConfig& config,
                      const Evaluate& evaluate);
void search_by_nsga2(const Space& space, const Objective& objective, const SearchConfig& config,
                     const Evaluate& evaluate);

}  // namespace understory
