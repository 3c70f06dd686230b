#include "scenarios/config/config_tree.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <utility>

namespace understory {
namespace {

/// Far above what any scenario needs: an alias that contains itself has no end.
constexpr int maximum_depth = 16;

std::string place(const std::string& name, const YAML::Mark& mark) {
  const bool has_lines = !name.starts_with("--set ");
  return mark.is_null() || !has_lines ? name : fmt::format("{}:{}", name, mark.line + 1);
}

/// `key` with the words that keys have had since version 0.2, so that older files learn the new name.
std::string renamed_key(std::string key) {
  for (const auto& [before, now] : {std::pair{"least", "minimum"}, std::pair{"greatest", "maximum"}})
    if (const auto at = key.find(before); at != std::string::npos) key.replace(at, std::strlen(before), now);
  return key;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

ConfigNode convert(const YAML::Node& yaml, const std::string& name, const std::string& path, int depth = 0) {
  ConfigNode node;
  node.origin = place(name, yaml.Mark());
  if (depth > maximum_depth) {
    throw ScenarioError(fmt::format("{}: {}: expected at most {} levels", node.origin,
                                    path.substr(0, path.find('[')), maximum_depth));
  }
  if (yaml.IsScalar()) {
    node.kind = ConfigNode::Kind::scalar;
    node.text = yaml.Scalar();
    node.quoted = yaml.Tag() == "!";
  } else if (yaml.IsSequence()) {
    node.kind = ConfigNode::Kind::list;
    for (const YAML::Node& child : yaml) {
      const std::string full = fmt::format("{}[{}]", path, node.children.size());
      node.children.push_back(convert(child, name, full, depth + 1));
    }
  } else if (yaml.IsMap()) {
    node.kind = ConfigNode::Kind::map;
    std::set<std::string> seen;
    for (const auto& entry : yaml) {
      const YAML::Node& key = entry.first;
      const std::string where = place(name, key.Mark());
      if (!key.IsScalar()) throw ScenarioError(fmt::format("{}: expected a plain word as key", where));
      const std::string full = path.empty() ? key.Scalar() : path + "." + key.Scalar();
      if (!seen.insert(key.Scalar()).second) {
        throw ScenarioError(
            fmt::format("{}: {}: expected each key once, this one is given twice", where, full));
      }
      node.children.push_back(convert(entry.second, name, full, depth + 1));
      node.children.back().key = key.Scalar();
      node.children.back().origin = where;
    }
  }
  return node;
}

class IgnoredEvents : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
  }
  void OnMapEnd() override {}
};

/// Not by YAML::LoadAll, which never returns from a stray comma (yaml-cpp 0.7 finds one empty document there
/// after the other).
bool holds_one_document(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  IgnoredEvents events;
  return parser.HandleNextDocument(events) && !parser.HandleNextDocument(events);
}

}  // namespace

ConfigNode parse_config_text(const std::string& text, const std::string& name) {
  YAML::Node document;
  try {
    if (holds_one_document(text)) document = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw ScenarioError(fmt::format("{}: expected YAML: {}", place(name, error.mark), one_line(error.msg)));
  }
  if (!document.IsMap()) {
    throw ScenarioError(fmt::format("{}:1: expected one YAML document with keys and values", name));
  }
  return convert(document, name, "");
}

ConfigNode parse_config_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw ScenarioError(fmt::format("{}: expected a scenario file, this is a folder", file.string()));
  }
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) throw ScenarioError(fmt::format("{}: expected a readable scenario file", file.string()));
  return parse_config_text(text, file.string());
}

ConfigNode under_keys(ConfigNode value, std::string keys) {
  while (true) {  // from the innermost key outwards
    const std::size_t dot = keys.rfind('.');
    value.key = dot == std::string::npos ? keys : keys.substr(dot + 1);
    ConfigNode map;
    map.kind = ConfigNode::Kind::map;
    map.origin = value.origin;
    map.children.push_back(std::move(value));
    value = std::move(map);
    if (dot == std::string::npos) return value;
    keys.resize(dot);
  }
}

ConfigNode parse_assignment(const std::string& assignment) {
  const std::string origin = "--set " + assignment;
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw ScenarioError(fmt::format("{}: expected key=value, for instance forest.length_m=60", origin));
  }
  ConfigNode value;
  try {
    value = convert(YAML::Load(assignment.substr(equals + 1)), origin, assignment.substr(0, equals));
  } catch (const YAML::Exception& error) {
    throw ScenarioError(fmt::format("{}: expected a YAML value: {}", origin, one_line(error.msg)));
  }
  return under_keys(std::move(value), assignment.substr(0, equals));
}

namespace {

/// The child that a word of a path names: "launch", or "faults[2]" for an entry of a list. None: null.
const ConfigNode* child_of(const ConfigNode& node, std::string_view word) {
  const std::size_t bracket = word.find('[');
  const auto found = std::find_if(node.children.begin(), node.children.end(), [&](const ConfigNode& child) {
    return child.key == word.substr(0, bracket);
  });
  if (found == node.children.end()) return nullptr;
  if (bracket == std::string_view::npos) return &*found;
  const std::size_t entry = std::stoul(std::string(word.substr(bracket + 1)));
  return entry < found->children.size() ? &found->children[entry] : nullptr;
}

}  // namespace

std::string origin_of(const std::vector<ConfigNode>& sources, std::string_view path) {
  for (auto source = sources.rbegin(); source != sources.rend(); ++source) {
    const ConfigNode* node = &*source;
    for (std::string_view rest = path; node != nullptr;) {
      const std::string_view key = rest.substr(0, rest.find('.'));
      node = child_of(*node, key);
      if (node != nullptr && key.size() == rest.size()) return node->origin;
      rest.remove_prefix(std::min(rest.size(), key.size() + 1));
    }
  }
  return "";
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  const std::string renamed = renamed_key(std::string(word));
  std::string best;
  if (std::ranges::find(known, renamed) != known.end()) best = renamed;
  std::size_t best_distance = !best.empty() ? 0 : std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& name : known) {  // Levenshtein, one row at a time
    std::vector<std::size_t> row(name.size() + 1);
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = i;
    for (std::size_t w = 1; w <= word.size(); ++w) {
      std::size_t diagonal = row[0];
      row[0] = w;
      for (std::size_t i = 1; i < row.size(); ++i) {
        const std::size_t replaced = diagonal + (word[w - 1] == name[i - 1] ? 0 : 1);
        diagonal = row[i];
        row[i] = std::min({replaced, row[i] + 1, row[i - 1] + 1});
      }
    }
    if (row.back() < best_distance) {
      best_distance = row.back();
      best = name;
    }
  }
  return best.empty() ? "" : fmt::format(" (did you mean {}?)", best);
}

}  // namespace understory
