#pragma once

#include <map>
#include <string>
#include <vector>

namespace understory {

/// A value for each parameter, in their order.
using Point = std::vector<double>;

/// One tuned key of a scenario and the values it may take: a range, or a list.
struct Parameter {
  std::string key;
  bool whole = false;               ///< whole numbers only
  double from = 0, to = 1;          ///< the range's ends, both included
  bool logarithmic = false;         ///< as many values to a factor, not to a difference; from > 0
  int steps = 0;                    ///< of a grid over the range; 0: not said
  std::vector<double> values = {};  ///< instead of a range, if any
};

/// The value at a share (0 .. 1, clamped) of the parameter's range or of its list; rounded to six
/// significant digits, so that what is written is what was tried, and to whole numbers where those are asked.
double value_at(const Parameter& parameter, double share);

/// The list, or `steps` (>= 2) values spread over the range; each once.
std::vector<double> spread_values(const Parameter& parameter, int steps);

/// What is searched.
struct Space {
  std::vector<Parameter> parameters;
  /// Of every list of which an entry is tuned, all entries as the scenario has them: lists are written whole.
  std::map<std::string, std::vector<double>> lists = {};
};

/// The keys of a point as YAML in groups, for load_scenario's `with`.
std::string to_yaml(const Space& space, const Point& point);
/// As people read it: "minimum_edge_sum 215, score_limit 0.25".
std::string in_words(const Space& space, const Point& point);
/// The last word of a key.
std::string short_key(const std::string& key);

}  // namespace understory
