#pragma once

#include <optional>
#include <string>
#include <vector>

namespace understory {

/// What a configuration was measured to be, in the order of the figures' names. NaN: could not be said (the
/// precision of no hits). Empty: the configuration was refused.
using Figures = std::vector<double>;

/// A figure to be driven up or down.
struct Goal {
  std::size_t figure = 0;  ///< place among the names
  bool maximize = true;
};

/// A figure that has to keep to one side of a bound, itself included.
struct Limit {
  std::size_t figure = 0;
  bool at_least = true;
  double bound = 0;
};

struct Objective {
  std::vector<Goal> goals;  ///< one or more
  std::vector<Limit> limits = {};
  /// Where one goal comes out the same, more of this figure (0 .. 1) is better: with 20 flights success takes
  /// 21 values.
  std::optional<std::size_t> tie_breaker = {};
};

/// Places of the figures that it speaks of, goals first, each once.
std::vector<std::size_t> figures_of(const Objective& objective);

/// How far the limits are missed, summed; 0 where all are kept, infinite where a goal or a limit's figure is
/// not known.
double violation(const Objective& objective, const Figures& figures);

/// To be minimised, a number per goal. Whatever keeps the limits is below 1 and ordered as the goals are;
/// what does not lies in 1 .. 2, the less it misses them the lower, for all goals the same: so it comes after
/// all that keeps them (the feasibility rules of Deb 2000, Comput. Methods Appl. Mech. Eng. 186).
std::vector<double> fitness(const Objective& objective, const Figures& figures);

/// The configuration to be recommended. One goal: the minimum fitness, the first of equals. Several: of those
/// that nobody beats in all goals, the nearest to the best of each goal, ranges scaled to 1 (the ideal point:
/// Zeleny 1973). Nothing where no limit is kept by any.
std::optional<std::size_t> best_of(const Objective& objective, const std::vector<Figures>& figures);

/// Places of those that no other beats in one of the goals' and limits' figures without being worse in
/// another, ordered by the first goal's figure; of equal ones the first. Limits need not be kept: the front
/// shows what each costs.
std::vector<std::size_t> pareto_front(const Objective& objective, const std::vector<Figures>& figures);

/// At most `count` of a front, ends included, as evenly over it as can be.
std::vector<std::size_t> thinned(const std::vector<std::size_t>& front, std::size_t count);

}  // namespace understory
