#include <yaml-cpp/yaml.h>

#include "perception/io/text_file.hpp"
#include "perception/io/text_tree.hpp"

namespace understory {
namespace {

/// Aliases make a small file a large tree, or one without end.
constexpr int greatest_depth = 16;
constexpr int greatest_node_count = 200'000;

class Conversion {
 public:
  explicit Conversion(const std::string& file) : file_(file) {}

  TextNode convert(const YAML::Node& yaml, int depth = 0) {
    TextNode node;
    node.line = line_of(yaml);
    if (depth > greatest_depth || ++node_count_ > greatest_node_count)
      throw_file_fault(file_, node.line, "rig", "expected a flat file of keys, this one nests without end");
    static const std::string standard = "tag:yaml.org,2002:";
    if (yaml.Tag().starts_with(standard)) node.type = yaml.Tag().substr(standard.size());
    if (yaml.IsScalar()) {
      node.kind = TextNode::Kind::scalar;
      node.text = yaml.Scalar();
    } else if (yaml.IsSequence()) {
      node.kind = TextNode::Kind::list;
      for (const YAML::Node& child : yaml) node.children.push_back(convert(child, depth + 1));
    } else if (yaml.IsMap()) {
      node.kind = TextNode::Kind::map;
      for (const auto& entry : yaml) {
        if (!entry.first.IsScalar())
          throw_file_fault(file_, line_of(entry.first), "rig", "expected a plain word as key");
        node.children.push_back(convert(entry.second, depth + 1));
        node.children.back().key = entry.first.Scalar();
        node.children.back().line = line_of(entry.first);
      }
    }
    return node;
  }

 private:
  static int line_of(const YAML::Node& yaml) { return yaml.Mark().is_null() ? 1 : yaml.Mark().line + 1; }

  const std::string& file_;
  int node_count_ = 0;
};

}  // namespace

TextNode parse_yaml(const std::string& text, const std::string& file) {
  std::vector<YAML::Node> documents;
  try {
    documents = YAML::LoadAll(text);
  } catch (const YAML::Exception& error) {
    throw_file_fault(file, error.mark.is_null() ? 1 : error.mark.line + 1, "rig",
                     "expected YAML: " + error.msg);
  }
  if (documents.size() != 1 || !documents.front().IsMap())
    throw_file_fault(file, 1, "rig", "expected one YAML document, a map of keys");
  return Conversion(file).convert(documents.front());
}

}  // namespace understory
