#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/config/config_tree.hpp"

/// For files whose keys are no struct's fields: campaigns, tunings.
namespace understory {

/// Throws ScenarioError "file:line: key: expected ...".
[[noreturn]] void refuse_key(const ConfigNode& node, const std::string& key, const std::string& expected);

/// Null where the map has no such key.
const ConfigNode* find_child(const ConfigNode& map, std::string_view key);

/// Refuses the first key that is none of `known`; `within` is what stands before it in the message.
void require_known_keys(const ConfigNode& map, const std::vector<std::string>& known,
                        const std::string& within);

/// A scalar, or each scalar of a list; refuses anything else, and nothing.
std::vector<std::string> words_of(const ConfigNode& node, const std::string& key,
                                  const std::string& expected);

/// What is no number, or lies outside minimum .. maximum, is refused.
double number_of(const ConfigNode& node, const std::string& key, double minimum, double maximum);
int whole_number_of(const ConfigNode& node, const std::string& key, int minimum, int maximum);

}  // namespace understory
