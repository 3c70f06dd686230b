#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "perception/io/field_reader.hpp"
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

/// Keys with their values as text, in order: "a.b.c", entries of lists of maps "faults[0].at_s".
using FlatKeys = std::vector<std::pair<std::string, std::string>>;

/// The keys of a YAML text whose top is a map; `name` stands for its file in messages.
FlatKeys flat_keys(const std::string& text, const std::string& name);
/// "-" where there is no such key.
std::string value_in(const FlatKeys& keys, std::string_view key);

/// Where the key "a.b.c" (or "a.list[2].c") was given: in the last of `sources` that holds it; empty where
/// none does.
std::string origin_of(const std::vector<ConfigNode>& sources, std::string_view path);

/// "cruise_speed_mps" of "autopilot.flight_model.cruise_speed_mps".
std::string short_key(const std::string& key);

/// The line where `top` has the key "a.b", or else the group that would hold it.
std::string nearest_origin(const ConfigNode& top, std::string key);

/// Throws ScenarioError "file:line: key: expected ...", with the nearest_origin() of the key.
[[noreturn]] void refuse_key(const ConfigNode& top, const std::string& key, const std::string& expected);
/// The same without "expected".
[[noreturn]] void refuse_key_since(const ConfigNode& top, const std::string& key, const std::string& what);

/// A JSON text's value, discarded (is_discarded()) where the text is broken or nests more than 16 levels.
/// Files that are large are refused before: read_file(file, maximum_json_bytes).
nlohmann::ordered_json parse_json(const std::string& text);

/// A value as JSON text, in one line or with that indentation. Bytes that are not UTF-8, as names of files
/// may have them, become U+FFFD.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

}  // namespace understory
