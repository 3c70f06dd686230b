#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "scenarios/config/field_visitor.hpp"

/// What a configuration's keys and a result's columns mean: the text that visit_fields() gives after a
/// field's name and bounds, in the form "meaning | source | unit". Source and unit may be absent: many
/// meanings have no source, and most names end with their unit.
namespace understory {

/// A key of a configuration, or a column of results.
struct Key {
  std::string name;   ///< "forest.length_m"; "faults[].at_s": of each entry of a list
  std::string value;  ///< as YAML has it; empty for a column, as is `range`
  std::string unit;   ///< empty: a number without one, a word
  std::string range;
  std::string meaning = {};
  std::string source = {};  ///< where the meaning names one: a page, a paper
  /// What a search may vary: a number's value, a list's entries; no seed, nothing optional.
  std::vector<double> numbers = {};
  double minimum = 0, maximum = 0;  ///< of each of `numbers`
  bool whole = false;               ///< whole numbers only
};

/// A key or column with unit, meaning and source as `text` and the end of its name say.
Key key_of(std::string_view name, std::string_view text);

/// The visitor that lists a struct's keys.
class KeyLister {
 public:
  explicit KeyLister(std::string prefix = "") : prefix_(std::move(prefix)) {}

  template <typename T>
  void operator()(std::string_view name, T& field, std::string_view meaning = {}) {
    if constexpr (std::is_same_v<T, bool>) {
      add(name, field ? "true" : "false", "true | false", meaning);
    } else if constexpr (std::is_same_v<T, std::string>) {
      add(name, field, "a word", meaning);
    } else if constexpr (requires { field.emplace_back(); }) {  // a list of structs
      typename T::value_type entry;
      list(std::string(name) + "[]", entry);
    } else {
      list(std::string(name), field);
    }
  }

  template <typename T, typename Least, typename Greatest>
  requires std::is_arithmetic_v<Least>
  void operator()(std::string_view name, T& field, Least minimum, Greatest maximum,
                  std::string_view meaning = {}) {
    const std::string range = fmt::format("{} .. {}", minimum, maximum);
    if constexpr (std::is_arithmetic_v<T>) {
      add(name, fmt::format("{}", field), range, meaning);
      if constexpr (!std::is_same_v<T, std::uint64_t>) add_number(field, minimum, maximum);
    } else if constexpr (requires { field.reset(); }) {  // std::optional
      add(name, field ? fmt::format("{}", *field) : "~", range, meaning);
    } else {
      std::string values;
      for (const auto value : field) values += fmt::format("{}{}", values.empty() ? "" : ", ", value);
      add(name, "[" + values + "]", range, meaning);
      for (const auto value : field) add_number(value, minimum, maximum);
    }
  }

  template <typename T, std::size_t N>
  void operator()(std::string_view name, T& field, const std::array<std::pair<std::string_view, T>, N>& names,
                  std::string_view meaning = {}) {
    std::string words, given;
    for (const auto& [word, value] : names) {
      words += (words.empty() ? "" : " | ") + std::string(word);
      if (field == value) given = word;
    }
    add(name, given, words, meaning);
  }

  void operator()(std::string_view name, std::string& field, const std::vector<std::string>& words,
                  std::string_view meaning = {}) {
    add(name, field, fmt::format("{}", fmt::join(words, " | ")), meaning);
  }

  const std::vector<Key>& keys() const { return keys_; }

 private:
  template <typename T>
  void list(const std::string& name, T& group) {
    KeyLister within(prefix_ + name + ".");
    visit_fields(within, group);
    keys_.insert(keys_.end(), within.keys_.begin(), within.keys_.end());
  }
  void add(std::string_view name, std::string value, std::string range, std::string_view meaning);
  void add_number(auto value, auto minimum, auto maximum) {
    Key& key = keys_.back();
    key.numbers.push_back(static_cast<double>(value));
    key.minimum = static_cast<double>(minimum);
    key.maximum = static_cast<double>(maximum);
    key.whole = std::is_integral_v<decltype(value)>;
  }

  std::string prefix_;
  std::vector<Key> keys_;
};

}  // namespace understory
