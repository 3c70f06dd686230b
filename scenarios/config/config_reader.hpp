#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "perception/io/text_table.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/config/field_visitor.hpp"

namespace understory {

/// The visitor that fills a config struct from a ConfigNode map: keys that are absent leave their fields
/// alone. Throws ScenarioError for a wrong type or a value out of range, and, in finish(), for keys the
/// struct has not.
class ConfigReader {
 public:
  ConfigReader(const ConfigNode& map, std::string path) : map_(map), path_(std::move(path)) {}

  template <typename T>
  void operator()(std::string_view name, T& field, std::string_view = {}) {
    const ConfigNode* node = take(name);
    if (node == nullptr) return;
    if constexpr (std::is_same_v<T, bool>) {
      if (node->text != "true" && node->text != "false") refuse(*node, name, "true or false");
      field = node->text == "true";
    } else if constexpr (std::is_same_v<T, std::string>) {
      if (node->kind != ConfigNode::Kind::scalar) refuse(*node, name, "a word");
      field = node->text;
    } else if constexpr (is_vector<T>::value) {  // of structs; of numbers, which have bounds, below
      if (node->kind != ConfigNode::Kind::list) refuse(*node, name, "a list of groups [{...}, ...]");
      field.assign(node->children.size(), {});  // a list is given whole: no entry outlives an earlier one
      for (std::size_t i = 0; i < field.size(); ++i) {
        read_group(node->children[i], fmt::format("{}[{}]", name, i), field[i]);
      }
    } else {
      read_group(*node, name, field);
    }
  }

  template <typename T, typename Least, typename Greatest>
  requires std::is_arithmetic_v<Least>
  void operator()(std::string_view name, T& field, Least minimum, Greatest maximum, std::string_view = {}) {
    const ConfigNode* node = take(name);
    if (node == nullptr) return;
    if constexpr (std::is_arithmetic_v<T>) {
      field = number<T>(*node, name, static_cast<T>(minimum), static_cast<T>(maximum));
    } else if constexpr (requires { field.reset(); }) {  // std::optional
      field.reset();
      if (node->kind == ConfigNode::Kind::nothing) return;
      using Number = typename T::value_type;
      field = number<Number>(*node, name, static_cast<Number>(minimum), static_cast<Number>(maximum));
    } else {  // Eigen::Vector3d, std::vector<double>
      constexpr bool fixed = std::is_same_v<T, Eigen::Vector3d>;
      if (node->kind != ConfigNode::Kind::list || (fixed && node->children.size() != 3)) {
        refuse(*node, name, fixed ? "a list of three numbers [x, y, z]" : "a list of numbers [a, b, ...]");
      }
      if constexpr (!fixed) field.resize(node->children.size());
      using Number = std::decay_t<decltype(field[0])>;
      for (std::size_t i = 0; i < node->children.size(); ++i)
        field[static_cast<typename std::conditional_t<fixed, Eigen::Index, std::size_t>>(i)] = number<Number>(
            node->children[i], name, static_cast<Number>(minimum), static_cast<Number>(maximum));
    }
  }

  template <typename T, std::size_t N>
  void operator()(std::string_view name, T& field, const std::array<std::pair<std::string_view, T>, N>& names,
                  std::string_view = {}) {
    const ConfigNode* node = take(name);
    if (node == nullptr) return;
    std::vector<std::string> words;
    for (const auto& [word, value] : names) {
      if (node->kind == ConfigNode::Kind::scalar && node->text == word) {
        field = value;
        return;
      }
      words.emplace_back(word);
    }
    refuse(*node, name, fmt::format("{}", fmt::join(words, " | ")), did_you_mean(node->text, words));
  }

  /// The value is one of `words`.
  void operator()(std::string_view name, std::string& field, const std::vector<std::string>& words,
                  std::string_view = {}) {
    const ConfigNode* node = take(name);
    if (node == nullptr) return;
    if (node->kind != ConfigNode::Kind::scalar || std::ranges::find(words, node->text) == words.end())
      refuse(*node, name, fmt::format("{}", fmt::join(words, " | ")), did_you_mean(node->text, words));
    field = node->text;
  }

  /// To be called after the last visit.
  void finish() const {
    for (const ConfigNode& child : map_.children) {
      if (std::ranges::find(known_, child.key) != known_.end()) continue;
      refuse_input(child.origin, full(child.key), "unknown key" + did_you_mean(child.key, known_));
    }
  }

 private:
  template <typename T>
  struct is_vector : std::false_type {};
  template <typename T>
  struct is_vector<std::vector<T>> : std::true_type {};

  template <typename T>
  void read_group(const ConfigNode& node, std::string_view name, T& field) {
    if (node.kind != ConfigNode::Kind::map) refuse(node, name, "a group of keys");
    ConfigReader nested(node, full(name));
    visit_fields(nested, field);
    nested.finish();
  }

  const ConfigNode* take(std::string_view name) {
    known_.emplace_back(name);
    return find_child(map_, name);
  }

  std::string full(std::string_view name) const {
    return path_.empty() ? std::string(name) : fmt::format("{}.{}", path_, name);
  }

  template <typename T>
  T number(const ConfigNode& node, std::string_view name, T minimum, T maximum) const {
    const bool is_plain = node.kind == ConfigNode::Kind::scalar && !node.quoted;
    const auto value = is_plain ? number_in<T>(node.text) : std::nullopt;
    if (!value || *value < minimum || *value > maximum) {
      constexpr std::string_view what = std::is_integral_v<T> ? "a whole number" : "a number";
      refuse(node, name, fmt::format("{} from {} to {}", what, minimum, maximum));
    }
    return *value;
  }

  [[noreturn]] void refuse(const ConfigNode& node, std::string_view name, std::string_view expected,
                           std::string_view hint = "") const {
    std::string got = node.text;
    if (node.kind == ConfigNode::Kind::nothing) got = "nothing";
    if (node.kind == ConfigNode::Kind::list) got = fmt::format("a list of {}", node.children.size());
    if (node.kind == ConfigNode::Kind::map) got = "a group of keys";
    refuse_input(node.origin, full(name), fmt::format("expected {}, got {}{}", expected, got, hint));
  }

  const ConfigNode& map_;
  std::string path_;
  std::vector<std::string> known_;
};

/// Fills `config` from `map`, all keys checked.
template <typename Config>
void read_config(const ConfigNode& map, Config& config) {
  ConfigReader reader(map, "");
  visit_fields(reader, config);
  reader.finish();
}

}  // namespace understory
