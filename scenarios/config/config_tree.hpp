#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "perception/io/text_tree.hpp"
#include "scenarios/output/errors.hpp"

namespace understory {

using ConfigNode = TextNode;

/// Reads one YAML document whose top is a map (parse_yaml). Throws ScenarioError where the file is missing or
/// broken.
ConfigNode parse_config_file(const std::filesystem::path& file);

/// "a.b.c=value" as a tree holding that one key. The value is YAML: a number, a word, a [list].
ConfigNode parse_assignment(const std::string& assignment);

/// `value` under the dotted key "a.b.c", as a tree holding that one key.
ConfigNode under_keys(ConfigNode value, std::string keys);

/// Where the key "a.b.c" (or "a.list[2].c") was given: in the last of `sources` that holds it; empty where
/// none does.
std::string origin_of(const std::vector<ConfigNode>& sources, std::string_view path);

/// " (did you mean NAME?)", of the known name that `word` most likely meant; empty where none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace understory
