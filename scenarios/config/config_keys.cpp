#include "scenarios/config/config_keys.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "perception/io/text_table.hpp"

namespace understory {
namespace {

template <typename Number>
Number parsed(const ConfigNode& node, const std::string& key, Number minimum, Number maximum,
              const char* what) {
  const bool is_plain = node.kind == ConfigNode::Kind::scalar && !node.quoted;
  const auto value = is_plain ? number_in<Number>(node.text) : std::nullopt;
  if (!value || *value < minimum || *value > maximum)
    refuse_key(node, key, fmt::format("{} from {} to {}", what, minimum, maximum));
  return *value;
}

}  // namespace

void refuse_key(const ConfigNode& node, const std::string& key, const std::string& expected) {
  refuse_input(node.origin, key, "expected " + expected);
}

const ConfigNode* find_child(const ConfigNode& map, std::string_view key) {
  const auto found = std::ranges::find(map.children, key, &ConfigNode::key);
  return found == map.children.end() ? nullptr : &*found;
}

void require_known_keys(const ConfigNode& map, const std::vector<std::string>& known,
                        const std::string& within) {
  for (const ConfigNode& node : map.children) {
    if (std::ranges::find(known, node.key) != known.end()) continue;
    const std::string near = did_you_mean(node.key, known);
    refuse_key(node, within + node.key,
               near.empty() ? fmt::format("one of {}", fmt::join(known, ", ")) : "a known key" + near);
  }
}

std::vector<std::string> words_of(const ConfigNode& node, const std::string& key,
                                  const std::string& expected) {
  std::vector<std::string> words;
  if (node.kind == ConfigNode::Kind::scalar && !node.text.empty()) words.push_back(node.text);
  if (node.kind == ConfigNode::Kind::list)
    for (const ConfigNode& entry : node.children) {
      if (entry.kind != ConfigNode::Kind::scalar) refuse_key(entry, key, expected);
      words.push_back(entry.text);
    }
  if (words.empty()) refuse_key(node, key, expected);
  return words;
}

double number_of(const ConfigNode& node, const std::string& key, double minimum, double maximum) {
  return parsed(node, key, minimum, maximum, "a number");
}

int whole_number_of(const ConfigNode& node, const std::string& key, int minimum, int maximum) {
  return parsed(node, key, minimum, maximum, "a whole number");
}

}  // namespace understory
