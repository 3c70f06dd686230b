#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "scenarios/config/field_visitor.hpp"

/// What a configuration's keys and a result's columns mean. The comment beside a struct's field says it,
/// once; the build reads the comments (cmake/field_texts.awk), the visitors add names, values and ranges.
namespace understory {

/// A field of a struct and its comment.
struct FieldText {
  const char *owner, *type, *name, *meaning;
};
/// Of all headers.
const std::vector<FieldText>& field_texts();

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

/// The key with unit, meaning and source of the field `name` of the struct `owner`, or of a struct within it.
Key key_of_field(std::string owner, const std::string& name);

/// The visitor that lists a struct's keys.
class KeyLister {
 public:
  explicit KeyLister(const std::type_info& owner, std::string prefix = "");

  template <typename T>
  void operator()(std::string_view name, T& field) {
    if constexpr (std::is_same_v<T, bool>) {
      add(name, field ? "true" : "false", "true | false");
    } else if constexpr (std::is_same_v<T, std::string>) {
      add(name, field, "a word");
    } else if constexpr (requires { field.emplace_back(); }) {  // a list of structs
      typename T::value_type entry;
      list(std::string(name) + "[]", entry);
    } else {
      list(std::string(name), field);
    }
  }

  template <typename T, typename Least, typename Greatest>
  void operator()(std::string_view name, T& field, Least minimum, Greatest maximum) {
    const std::string range = fmt::format("{} .. {}", minimum, maximum);
    if constexpr (std::is_arithmetic_v<T>) {
      add(name, fmt::format("{}", field), range);
      if constexpr (!std::is_same_v<T, std::uint64_t>) add_number(field, minimum, maximum);
    } else if constexpr (requires { field.reset(); }) {  // std::optional
      add(name, field ? fmt::format("{}", *field) : "~", range);
    } else {
      std::string values;
      for (const auto value : field) values += fmt::format("{}{}", values.empty() ? "" : ", ", value);
      add(name, "[" + values + "]", range);
      for (const auto value : field) add_number(value, minimum, maximum);
    }
  }

  template <typename T, std::size_t N>
  void operator()(std::string_view name, T& field,
                  const std::array<std::pair<std::string_view, T>, N>& names) {
    std::string words, given;
    for (const auto& [word, value] : names) {
      words += (words.empty() ? "" : " | ") + std::string(word);
      if (field == value) given = word;
    }
    add(name, given, words);
  }

  void operator()(std::string_view name, std::string& field, const std::vector<std::string>& words) {
    add(name, field, fmt::format("{}", fmt::join(words, " | ")));
  }
  /// Says what the newest key means, where no comment of ours does.
  void explain(std::string_view meaning) { keys_.back().meaning = meaning; }

  const std::vector<Key>& keys() const { return keys_; }

 private:
  template <typename T>
  void list(const std::string& name, T& group) {
    KeyLister within(typeid(T), prefix_ + name + ".");
    visit_fields(within, group);
    keys_.insert(keys_.end(), within.keys_.begin(), within.keys_.end());
  }
  void add(std::string_view name, std::string value, std::string range);
  void add_number(auto value, auto minimum, auto maximum) {
    Key& key = keys_.back();
    key.numbers.push_back(static_cast<double>(value));
    key.minimum = static_cast<double>(minimum);
    key.maximum = static_cast<double>(maximum);
    key.whole = std::is_integral_v<decltype(value)>;
  }

  std::string owner_, prefix_;
  std::vector<Key> keys_;
};

}  // namespace understory
