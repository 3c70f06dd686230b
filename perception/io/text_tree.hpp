#pragma once

#include <string>
#include <vector>

namespace understory {

/// A small file of keys and values as written, before anybody knows what the keys mean: the common ground of
/// YAML and of OpenCV's XML. StrictMap takes typed values out of it.
struct TextNode {
  enum class Kind { nothing, scalar, list, map };
  Kind kind = Kind::nothing;
  int line = 1;      ///< where its key (in a list: the value) stands
  std::string key;   ///< within the enclosing map; empty in lists and at the top
  std::string type;  ///< YAML's tag without "!!", XML's type_id: "opencv-matrix"; mostly empty
  std::string text;  ///< of a scalar
  std::vector<TextNode> children;
};

/// Reads one YAML document whose top is a map; `file` stands for it in messages. OpenCV's own dialect
/// ("%YAML:1.0" in the first line) is YAML enough. Throws as throw_file_fault does.
TextNode parse_yaml(const std::string& text, const std::string& file);

/// Reads XML as OpenCV writes it: elements below <opencv_storage>, type_id the only attribute with a meaning,
/// several words in an element a list. No DOCTYPE, no CDATA. Throws as throw_file_fault does.
TextNode parse_opencv_xml(const std::string& text, const std::string& file);

}  // namespace understory
