#pragma once

#include <string>
#include <vector>

#include "perception/io/text_tree.hpp"

namespace understory {

/// One map of a file, read key by key; says where it went wrong. Every function throws InputError
/// where the key is missing, mistyped or out of range.
class StrictMap {
 public:
  /// `prefix`: how the map itself is called in messages, "T_BS." for instance. Throws where `map` is no map.
  explicit StrictMap(TextNode map, std::string prefix = "");

  bool has(const std::string& key) const { return find_child(map_, key) != nullptr; }

  std::string text(const std::string& key);
  double number(const std::string& key, double minimum, double maximum);
  int whole(const std::string& key, int minimum, int maximum);
  /// A list of numbers, `count` of them.
  std::vector<double> numbers(const std::string& key, std::size_t count, double minimum, double maximum);
  /// How many values the list has; 0 where it is none or missing.
  std::size_t length(const std::string& key) const;
  StrictMap map(const std::string& key);
  /// What the value calls itself: "opencv-matrix".
  std::string type(const std::string& key) { return take(key).type; }

  /// To be called once every known key was asked for. `harmless`: keys that may stand in a file of others,
  /// since they change nothing: " E F Q ".
  void refuse_others(std::string_view harmless = "") const;

  [[noreturn]] void fail(const std::string& key, const std::string& expected) const;

 private:
  const TextNode& take(const std::string& key);
  double number(const TextNode& node, const std::string& key, double minimum, double maximum) const;

  TextNode map_;
  std::string prefix_;
  std::vector<std::string> known_;  // in the order asked for
};

}  // namespace understory
