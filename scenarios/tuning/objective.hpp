#pragma once

#include <optional>
#include <vector>

namespace understory {

/// The measured figures of a configuration, in the order of their names. NaN: undefined (the precision of no
/// hits). Empty: the configuration was refused.
using Figures = std::vector<double>;

/// A figure to be maximised or minimised.
struct Goal {
  std::size_t figure = 0;  ///< place among the names
  bool maximize = true;
};

/// A figure that has to stay on one side of a bound, which is itself allowed.
struct Limit {
  std::size_t figure = 0;
  bool at_least = true;
  double bound = 0;
};

struct Objective {
  std::vector<Goal> goals;  ///< one or more
  std::vector<Limit> limits = {};
  /// With one goal: if that is equal, more of this figure (0 .. 1) is better: with 20 flights success takes
  /// 21 values.
  std::optional<std::size_t> tie_breaker = {};
};

/// Places of the figures that it uses, goals first, each once.
std::vector<std::size_t> figures_of(const Objective& objective);

/// How far the limits are missed, summed; 0 where all are kept, infinite where a goal or a limit's figure is
/// not known.
double violation(const Objective& objective, const Figures& figures);

/// To be minimised, a number per goal. Below 1 and ordered as the goals are if all limits are kept; otherwise
/// in 1 .. 2, the lower the less the limits are missed, the same for all goals: so it comes after all that
/// keep them (the feasibility rules of Deb 2000, Comput. Methods Appl. Mech. Eng. 186).
std::vector<double> fitness(const Objective& objective, const Figures& figures);

/// The configuration to be recommended. One goal: the minimum fitness, the first of equals. Several: of those
/// that no other beats in all goals, the nearest to the best of each goal, ranges scaled to 1 (the ideal
/// point: Zeleny 1973). Nothing if none keeps all limits.
std::optional<std::size_t> best_of(const Objective& objective, const std::vector<Figures>& figures);

/// Places of the configurations that no other beats in one of the goals' and limits' figures without being
/// worse in another, ordered by the first goal's figure; of equal ones the first. Limits need not be kept:
/// the front shows what each costs.
std::vector<std::size_t> pareto_front(const Objective& objective, const std::vector<Figures>& figures);

/// At most `count` of a front, ends included, as evenly over it as can be.
std::vector<std::size_t> thinned(const std::vector<std::size_t>& front, std::size_t count);

}  // namespace understory
