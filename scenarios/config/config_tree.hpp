#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/output/errors.hpp"

namespace understory {

/// A configuration as written, before anybody knows what its keys mean. It stands between YAML and the
/// visitors, so that yaml-cpp stays in one source file and a --set argument passes the same checks as a line
/// of a file.
struct ConfigNode {
  enum class Kind { nothing, scalar, list, map };
  Kind kind = Kind::nothing;
  std::string origin;   ///< "forest.yaml:12" or "--set forest.length_m=20"
  std::string key;      ///< within the enclosing map; empty in lists and at the top
  std::string text;     ///< of a scalar
  bool quoted = false;  ///< a quoted scalar is a string, never a number
  std::vector<ConfigNode> children;
};

/// Reads one YAML document whose top is a map. Throws ScenarioError where the file is missing or broken, or
/// where a map holds a key twice (yaml-cpp itself takes either silently).
ConfigNode parse_config_file(const std::filesystem::path& file);

/// The same from text; `name` stands for the file in messages.
ConfigNode parse_config_text(const std::string& text, const std::string& name);

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
