#include "perception/io/strict_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "perception/io/text_file.hpp"
#include "perception/io/text_table.hpp"

namespace understory {

StrictMap::StrictMap(TextNode map, std::string prefix) : map_(std::move(map)), prefix_(std::move(prefix)) {
  if (map_.kind != TextNode::Kind::map)
    refuse_input(map_.origin, map_.key, "must be a map of keys and values");
}

std::string StrictMap::text(const std::string& key) {
  const TextNode& node = take(key);
  if (node.kind != TextNode::Kind::scalar || node.text.empty()) fail(key, "must be text");
  return node.text;
}

std::string StrictMap::joined_text(const std::string& key) {
  const TextNode& node = take(key);
  std::string text = node.text;
  for (const TextNode& child : node.children) text += child.text;
  return text;
}

double StrictMap::number(const std::string& key, double minimum, double maximum) {
  return number(take(key), key, minimum, maximum);
}

int StrictMap::whole(const std::string& key, int minimum, int maximum) {
  const double value = number(key, minimum, maximum);
  if (value != std::floor(value)) fail(key, "must be a whole number");
  return static_cast<int>(value);
}

std::vector<double> StrictMap::numbers(const std::string& key, std::size_t count, double minimum,
                                       double maximum) {
  const TextNode& list = take(key);
  const bool is_list =
      list.kind == TextNode::Kind::list || (count == 0 && list.kind == TextNode::Kind::nothing);
  std::vector<const TextNode*> nodes;
  for (const TextNode& child : list.children) {
    if (child.kind != TextNode::Kind::list)
      nodes.push_back(&child);
    else
      for (const TextNode& of_row : child.children) nodes.push_back(&of_row);
  }
  if (!is_list || nodes.size() != count)
    fail(key, fmt::format("must be a list of {} numbers{}", count,
                          is_list ? fmt::format(", found {}", nodes.size()) : ""));
  std::vector<double> values;
  for (const TextNode* node : nodes) values.push_back(number(*node, key, minimum, maximum));
  return values;
}

std::size_t StrictMap::length(const std::string& key) const {
  const TextNode* node = find_child(map_, key);
  return node != nullptr && node->kind == TextNode::Kind::list ? node->children.size() : 0;
}

StrictMap StrictMap::map(const std::string& key) { return StrictMap(take(key), prefix_ + key + "."); }

void StrictMap::refuse_others(std::string_view harmless) const {
  for (const TextNode& child : map_.children)
    if (std::find(known_.begin(), known_.end(), child.key) == known_.end() &&
        harmless.find(' ' + child.key + ' ') == std::string_view::npos)
      fail(child.key, harmless.empty()
                          ? fmt::format("unknown key; known here: {}", fmt::join(known_, ", "))
                          : "unknown key: it may change what the other numbers mean, and it is not read");
}

void StrictMap::fail(const std::string& key, const std::string& expected) const {
  const TextNode* node = find_child(map_, key);
  refuse_input(node != nullptr ? node->origin : map_.origin, prefix_ + key, expected);
}

const TextNode& StrictMap::take(const std::string& key) {
  known_.push_back(key);
  const TextNode* node = find_child(map_, key);
  if (node == nullptr) fail(key, "missing");
  return *node;
}

double StrictMap::number(const TextNode& node, const std::string& key, double minimum, double maximum) const {
  const auto value = node.kind == TextNode::Kind::scalar ? number_in(node.text) : std::nullopt;
  if (value && *value >= minimum && *value <= maximum) return *value;
  refuse_input(node.origin, prefix_ + key,
               fmt::format("must be a number from {} to {}{}", minimum, maximum,
                           node.kind == TextNode::Kind::scalar ? ", found '" + node.text + "'" : ""));
}

}  // namespace understory
