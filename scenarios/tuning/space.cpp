#include "scenarios/tuning/space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

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

std::vector<std::string> words_between_dots(const std::string& key) {
  std::vector<std::string> words(1);
  for (const char c : key) {
    if (c == '.')
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
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

std::string to_yaml(const Space& space, const Point& point) {
  std::string yaml;
  std::vector<std::string> open;  // groups
  for (const auto& [key, value] : written_values(space, point)) {
    const std::vector<std::string> words = words_between_dots(key);
    std::size_t shared = 0;
    while (shared < open.size() && shared + 1 < words.size() && open[shared] == words[shared]) ++shared;
    for (std::size_t level = shared; level + 1 < words.size(); ++level)
      yaml += fmt::format("{:{}}{}:\n", "", 2 * level, words[level]);
    yaml += fmt::format("{:{}}{}: {}\n", "", 2 * (words.size() - 1), words.back(), value);
    open.assign(words.begin(), words.end() - 1);
  }
  return yaml;
}

std::string in_words(const Space& space, const Point& point) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < point.size(); ++i)
    words.push_back(fmt::format("{} {:g}", short_key(space.parameters[i].key), point[i]));
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string short_key(const std::string& key) { return key.substr(key.rfind('.') + 1); }

}  // namespace understory
