#include "scenarios/config/config_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace understory {
namespace {

/// The child that a word of a path names: "launch", or "faults[2]" for an entry of a list. None: null.
const ConfigNode* child_of(const ConfigNode& node, std::string_view word) {
  const std::size_t bracket = word.find('[');
  const ConfigNode* child = find_child(node, word.substr(0, bracket));
  if (child == nullptr || bracket == std::string_view::npos) return child;
  const std::size_t entry = std::stoul(std::string(word.substr(bracket + 1)));
  return entry < child->children.size() ? &child->children[entry] : nullptr;
}

void flatten(const ConfigNode& node, const std::string& path, FlatKeys& keys) {
  const bool is_list = node.kind == ConfigNode::Kind::list;
  if (node.kind == ConfigNode::Kind::map) {
    for (const ConfigNode& child : node.children)
      flatten(child, path.empty() ? child.key : path + "." + child.key, keys);
  } else if (is_list && !node.children.empty() && node.children[0].kind == ConfigNode::Kind::map) {
    for (std::size_t i = 0; i < node.children.size(); ++i)
      flatten(node.children[i], fmt::format("{}[{}]", path, i), keys);
  } else if (is_list) {
    std::string values;
    for (const ConfigNode& child : node.children) values += (values.empty() ? "" : ", ") + child.text;
    keys.emplace_back(path, "[" + values + "]");
  } else {
    keys.emplace_back(path, node.kind == ConfigNode::Kind::nothing ? "~" : node.text);
  }
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
  constexpr std::size_t maximum_shown = 200;
  constexpr std::ptrdiff_t maximum_levels = 16;  // as in a file
  const std::string origin =
      "--set " +
      (assignment.size() <= maximum_shown ? assignment : assignment.substr(0, maximum_shown) + "...");
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw ScenarioError(fmt::format("{}: must be key=value, for instance forest.length_m=60", origin));
  }
  const std::string key = assignment.substr(0, equals);
  if (std::ranges::count(key, '.') >= maximum_levels)
    throw ScenarioError(fmt::format("{}: a key may have at most {} levels", origin, maximum_levels));
  return under_keys(parse_yaml_value(assignment.substr(equals + 1), origin, key), key);
}

FlatKeys flat_keys(const std::string& text, const std::string& name) {
  FlatKeys keys;
  flatten(parse_yaml(text, name), "", keys);
  return keys;
}

std::string value_in(const FlatKeys& keys, std::string_view key) {
  const auto found = std::ranges::find(keys, key, [](const auto& entry) { return entry.first; });
  return found == keys.end() ? "-" : found->second;
}

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

std::string short_key(const std::string& key) { return key.substr(key.rfind('.') + 1); }

std::string nearest_origin(const ConfigNode& top, std::string key) {
  while (!key.empty()) {
    if (const std::string origin = origin_of({top}, key); !origin.empty()) return origin;
    const std::size_t dot = key.rfind('.');
    key.resize(dot == std::string::npos ? 0 : dot);
  }
  return top.origin;
}

void refuse_key(const ConfigNode& top, const std::string& key, const std::string& expected) {
  refuse_key_since(top, key, "expected " + expected);
}

void refuse_key_since(const ConfigNode& top, const std::string& key, const std::string& what) {
  refuse_input(nearest_origin(top, key), key, what);
}

nlohmann::ordered_json parse_json(const std::string& text) {
  using Json = nlohmann::ordered_json;
  constexpr int maximum_depth = 16;
  struct TooDeep {};
  const auto bounded = [](int depth, Json::parse_event_t, Json&) {
    return depth <= maximum_depth ? true : throw TooDeep();
  };
  try {
    return Json::parse(text, bounded, false);
  } catch (const TooDeep&) {
    return Json(Json::value_t::discarded);
  }
}

std::string json_text(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace understory
