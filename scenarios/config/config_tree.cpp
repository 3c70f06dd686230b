#include "scenarios/config/config_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace understory {
namespace {

/// `key` with the words that keys have had since version 0.2, so that older files learn the new name.
std::string renamed_key(std::string key) {
  for (const auto& [before, now] : {std::pair{"least", "minimum"}, std::pair{"greatest", "maximum"}})
    if (const auto at = key.find(before); at != std::string::npos) key.replace(at, std::strlen(before), now);
  return key;
}

}  // namespace

ConfigNode parse_config_file(const std::filesystem::path& file) {
  return parse_yaml(read_file(file), file.string());
}

ConfigNode under_keys(ConfigNode value, std::string keys) {
  while (true) {  // from the innermost key outwards
    const std::size_t dot = keys.rfind('.');
    value.key = dot == std::string::npos ? keys : keys.substr(dot + 1);
    ConfigNode map;
    map.kind = ConfigNode::Kind::map;
    map.origin = value.origin;
    map.children.push_back(std::move(value));
    value = std::move(map);
    if (dot == std::string::npos) return value;
    keys.resize(dot);
  }
}

ConfigNode parse_assignment(const std::string& assignment) {
  const std::string origin = "--set " + assignment;
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw ScenarioError(fmt::format("{}: expected key=value, for instance forest.length_m=60", origin));
  }
  const std::string key = assignment.substr(0, equals);
  return under_keys(parse_yaml_value(assignment.substr(equals + 1), origin, key), key);
}

namespace {

/// The child that a word of a path names: "launch", or "faults[2]" for an entry of a list. None: null.
const ConfigNode* child_of(const ConfigNode& node, std::string_view word) {
  const std::size_t bracket = word.find('[');
  const auto found = std::find_if(node.children.begin(), node.children.end(), [&](const ConfigNode& child) {
    return child.key == word.substr(0, bracket);
  });
  if (found == node.children.end()) return nullptr;
  if (bracket == std::string_view::npos) return &*found;
  const std::size_t entry = std::stoul(std::string(word.substr(bracket + 1)));
  return entry < found->children.size() ? &found->children[entry] : nullptr;
}

}  // namespace

std::string origin_of(const std::vector<ConfigNode>& sources, std::string_view path) {
  for (auto source = sources.rbegin(); source != sources.rend(); ++source) {
    const ConfigNode* node = &*source;
    for (std::string_view rest = path; node != nullptr;) {
      const std::string_view key = rest.substr(0, rest.find('.'));
      node = child_of(*node, key);
      if (node != nullptr && key.size() == rest.size()) return node->origin;
      rest.remove_prefix(std::min(rest.size(), key.size() + 1));
    }
  }
  return "";
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  const std::string renamed = renamed_key(std::string(word));
  std::string best;
  if (std::ranges::find(known, renamed) != known.end()) best = renamed;
  std::size_t best_distance = !best.empty() ? 0 : std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& name : known) {  // Levenshtein, one row at a time
    std::vector<std::size_t> row(name.size() + 1);
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = i;
    for (std::size_t w = 1; w <= word.size(); ++w) {
      std::size_t diagonal = row[0];
      row[0] = w;
      for (std::size_t i = 1; i < row.size(); ++i) {
        const std::size_t replaced = diagonal + (word[w - 1] == name[i - 1] ? 0 : 1);
        diagonal = row[i];
        row[i] = std::min({replaced, row[i] + 1, row[i - 1] + 1});
      }
    }
    if (row.back() < best_distance) {
      best_distance = row.back();
      best = name;
    }
  }
  return best.empty() ? "" : fmt::format(" (did you mean {}?)", best);
}

}  // namespace understory
