#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "perception/field_visitor.hpp"

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

/// Every key of the fields with its value; `prefix` stands before the names.
std::vector<Key> list_keys(const Fields& fields, const std::string& prefix = "");

}  // namespace understory
