#pragma once

#include <string>
#include <vector>

#include "perception/io/text_tree.hpp"

namespace understory {

/// Reads one map of a file key by key and reports the place of an error. Every function throws InputError if
/// the key is missing, mistyped or out of range.
class StrictMap {
 public:
  /// `prefix`: name of the map in messages, for example "T_BS.". Throws if `map` is not a map.
  explicit StrictMap(TextNode map, std::string prefix = "");

  bool has(const std::string& key) const { return find_child(map_, key) != nullptr; }

  std::string text(const std::string& key);
  /// The words of a list one after the other, or a text.
  std::string joined_text(const std::string& key);
  double number(const std::string& key, double minimum, double maximum);
  int whole(const std::string& key, int minimum, int maximum);
  /// A list of numbers, `count` of them; or a list of such lists, as rows of a matrix.
  std::vector<double> numbers(const std::string& key, std::size_t count, double minimum, double maximum);
  /// How many values the list has; 0 if it is missing or not a list.
  std::size_t length(const std::string& key) const;
  StrictMap map(const std::string& key);
  /// The value's type tag: "opencv-matrix".
  std::string type(const std::string& key) { return take(key).type; }

  /// Throws if the map has a key that was not read; call it after all known keys were read. `harmless`: keys
  /// that other programs' files may have besides, because they change nothing: " E F Q ".
  void refuse_others(std::string_view harmless = "") const;

  [[noreturn]] void fail(const std::string& key, const std::string& expected) const;

 private:
  const TextNode& take(const std::string& key);
  double number(const TextNode& node, const std::string& key, double minimum, double maximum) const;

  TextNode map_;
  std::string prefix_;
  std::vector<std::string> known_;  // in the order of the calls
};

}  // namespace understory
