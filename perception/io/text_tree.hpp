#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace understory {

/// Keys and values as written, not yet interpreted: the common form of YAML, OpenCV's XML and --set
/// arguments. read_fields() takes typed values out of it; StrictMap does for calibrations of other programs.
struct TextNode {
  enum class Kind { nothing, scalar, list, map };
  Kind kind = Kind::nothing;
  std::string origin;   ///< "forest.yaml:12", of its key (in a list: of the value), or "--set a.b=20"
  std::string key;      ///< within the enclosing map; empty in lists and at the top
  std::string type;     ///< YAML's tag without "!!", XML's type_id: "opencv-matrix"; mostly empty
  std::string text;     ///< of a scalar
  bool quoted = false;  ///< a quoted scalar is a string, never a number
  std::vector<TextNode> children;
};

/// Null where the map has no such key.
const TextNode* find_child(const TextNode& map, std::string_view key);

/// Reads one YAML document whose top is a map; `file` stands for it in messages. OpenCV's own dialect
/// ("%YAML:1.0" in the first line) is YAML enough. An alias becomes a copy of what it names. Throws
/// InputError at broken YAML, a key given twice, more than 16 levels, or more than 100,000 values, copies
/// included.
TextNode parse_yaml(const std::string& text, const std::string& file);

/// Reads any YAML value, as parse_yaml does; nothing from an empty text. Every node's origin is `origin`;
/// `key` stands before the value's own keys in messages.
TextNode parse_yaml_value(const std::string& text, const std::string& origin, const std::string& key);

/// Reads XML as OpenCV writes it: elements below <opencv_storage>, type_id the only attribute with a meaning,
/// several words in an element a list. No DOCTYPE, no CDATA. Throws as parse_yaml does.
TextNode parse_opencv_xml(const std::string& text, const std::string& file);

/// Reads lines of a key, `separator`, and words, which are parted by blanks, brackets and semicolons: a
/// scalar, or a list of several. Throws InputError at another line, and at a key given twice.
TextNode parse_keyed_lines(const std::string& text, const std::string& file, char separator);

/// Throws InputError where a map in the tree holds a key twice, as the parsers above do. `path` stands before
/// the tree's own keys in the message.
void refuse_double_keys(const TextNode& node, const std::string& path = "");

}  // namespace understory
