#include "scenarios/tuning/search.hpp"
#include "scenarios/config/config_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <random>

namespace understory {
namespace {

double rounded(const Parameter& parameter, double value) {
  if (parameter.whole) return std::round(value);
  const std::string text = fmt::format("{:.6g}", value);
  std::from_chars(text.data(), text.data() + text.size(), value);
  return std::clamp(value, parameter.from, parameter.to);
}

/// "depths_m[1]" is entry 1 of "depths_m"; a key without brackets has none.
std::size_t entry_of(const std::string& key) { return std::stoul(key.substr(key.find('[') + 1)); }

/// Key and value as written, by key, so that those of a group stand together.
std::map<std::string, std::string> written_values(const Space& space, const Point& point) {
  std::map<std::string, std::string> written;
  auto lists = space.lists;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const std::string& key = space.parameters[i].key;
    if (key.ends_with(']'))
      lists.at(key.substr(0, key.find('['))).at(entry_of(key)) = point[i];
    else
      written[key] = fmt::format("{}", point[i]);
  }
  for (const auto& [key, values] : lists) written[key] = fmt::format("[{}]", fmt::join(values, ", "));
  return written;
}

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

double value_at(const Parameter& parameter, double share) {
  share = std::clamp(share, 0.0, 1.0);
  if (!parameter.values.empty()) {
    const auto count = static_cast<double>(parameter.values.size());
    return parameter.values[static_cast<std::size_t>(std::min(std::floor(share * count), count - 1))];
  }
  if (parameter.whole && !parameter.logarithmic) {  // every number has as much of the share
    const double count = parameter.to - parameter.from + 1;
    return parameter.from + std::min(std::floor(share * count), count - 1);
  }
  const double value = parameter.logarithmic ? parameter.from * std::pow(parameter.to / parameter.from, share)
                                             : parameter.from + share * (parameter.to - parameter.from);
  return rounded(parameter, value);
}

std::vector<double> spread_values(const Parameter& parameter, int steps) {
  if (!parameter.values.empty()) return parameter.values;
  Parameter range = parameter;
  range.whole = false;
  std::vector<double> values;
  for (int step = 0; step < steps; ++step) {
    const double value = rounded(parameter, value_at(range, static_cast<double>(step) / (steps - 1)));
    if (values.empty() || values.back() != value) values.push_back(value);
  }
  return values;
}

std::vector<std::string> keys_of(const Space& space) {
  std::vector<std::string> keys;
  for (const Parameter& parameter : space.parameters) keys.push_back(parameter.key);
  return keys;
}

std::string to_yaml(const Space& space, const Point& point) {
  std::string yaml, open;  // the group that is open: "perception.pushbroom."
  for (const auto& [key, value] : written_values(space, point)) {
    std::size_t begin = 0, level = 0;
    for (std::size_t dot; (dot = key.find('.', begin)) != std::string::npos; begin = dot + 1, ++level)
      if (!open.starts_with(key.substr(0, dot + 1)))
        yaml += fmt::format("{:{}}{}:\n", "", 2 * level, key.substr(begin, dot - begin));
    yaml += fmt::format("{:{}}{}: {}\n", "", 2 * level, key.substr(begin), value);
    open = key.substr(0, begin);
  }
  return yaml;
}

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
