#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/tuning/objective.hpp"

namespace understory {

/// A value for each parameter, in their order.
using Point = std::vector<double>;

/// One tuned key of a scenario and the values it may take: a range, or a list.
struct Parameter {
  std::string key;
  bool whole = false;               ///< whole numbers only
  double from = 0, to = 1;          ///< the range's ends, both included
  bool logarithmic = false;         ///< equal factors, not differences, have as many values; from > 0
  int steps = 0;                    ///< of a grid over the range; 0: not said
  std::vector<double> values = {};  ///< instead of a range, if any
};

/// The value at a share (0 .. 1, clamped) of the parameter's range or of its list; rounded to six
/// significant digits, so that written and tried values are equal; whole parameters get whole numbers.
double value_at(const Parameter& parameter, double share);

/// The list, or `steps` (>= 2) values spread over the range; each once.
std::vector<double> spread_values(const Parameter& parameter, int steps);

/// What is searched.
struct Space {
  std::vector<Parameter> parameters;
  /// All entries, as in the scenario, of every list with a tuned entry: lists are written whole.
  std::map<std::string, std::vector<double>> lists = {};
};

std::vector<std::string> keys_of(const Space& space);
/// The keys of a point as YAML in groups, for load_scenario's `with`.
std::string to_yaml(const Space& space, const Point& point);

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

/// Measures one point. An exception from it ends the search and is passed on.
using Evaluate = std::function<Figures(const Point&)>;

/// Calls `evaluate` `trials` times, one point after the other. The sequence of points depends on nothing but
/// the arguments and what `evaluate` gave, so that a search can be repeated from a log of its figures.
void search(const Space& space, const Objective& objective, const SearchConfig& config,
            const Evaluate& evaluate);

/// Points of a grid: as many as it has.
std::size_t grid_size(const Space& space);

/// The two methods of the library (pagmo): in a file of their own, whose headers compile slowly, and in the
/// program in a module of their own, which loads slowly (docs/decisions/014).
void search_by_cma_es(const Space& space, const Objective& objective, const SearchConfig& config,
                      const Evaluate& evaluate);
void search_by_nsga2(const Space& space, const Objective& objective, const SearchConfig& config,
                     const Evaluate& evaluate);

/// Both methods, as their module provides them.
struct EvolutionMethods {
  using Method = void (*)(const Space&, const Objective&, const SearchConfig&, const Evaluate&);
  Method cma_es, nsga2;
};

}  // namespace understory
