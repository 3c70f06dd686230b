#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <optional>
#include <sstream>

#include "perception/io/text_file.hpp"
#include "perception/io/text_tree.hpp"

namespace understory {
namespace {

constexpr std::size_t maximum_depth = 16;

/// Builds the tree from the parser's events, because yaml-cpp's own loaders cannot be left alone with a
/// strange file: YAML::LoadAll (0.7) finds documents without end behind a stray comma, and an alias that
/// contains itself makes a node without end. Here both end at the first event that a file of keys would not
/// have.
class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(const std::string& file) : file_(file) {}

  TextNode take_root() {
    if (!root_ || root_->kind != TextNode::Kind::map) fail(1, not_a_map);
    return std::move(*root_);
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (root_) fail(line_of(mark), not_a_map);
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    add(node_of(mark, "", TextNode::Kind::nothing));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    fail(line_of(mark), "expected values written out, found an alias");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& value) override {
    TextNode node = node_of(mark, tag, TextNode::Kind::scalar);
    node.text = value;
    add(std::move(node));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(node_of(mark, tag, TextNode::Kind::list));
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    open(node_of(mark, tag, TextNode::Kind::map));
  }
  void OnMapEnd() override { close(); }

 private:
  static constexpr const char* not_a_map = "expected one YAML document, a map of keys";

  struct OpenNode {
    TextNode node;
    std::optional<TextNode> key;  ///< read, and its value not yet
  };

  static int line_of(const YAML::Mark& mark) { return mark.is_null() ? 1 : mark.line + 1; }

  static TextNode node_of(const YAML::Mark& mark, const std::string& tag, TextNode::Kind kind) {
    static const std::string standard = "tag:yaml.org,2002:";
    TextNode node;
    node.kind = kind;
    node.line = line_of(mark);
    if (tag.starts_with(standard)) node.type = tag.substr(standard.size());
    return node;
  }

  void open(TextNode node) {
    if (open_.size() >= maximum_depth) fail(node.line, "expected at most 16 lists and maps in each other");
    if (!open_.empty() && expects_key()) fail(node.line, "expected a plain word as key");
    open_.push_back({std::move(node), std::nullopt});
  }

  void close() {
    TextNode node = std::move(open_.back().node);
    open_.pop_back();
    add(std::move(node));
  }

  bool expects_key() const { return open_.back().node.kind == TextNode::Kind::map && !open_.back().key; }

  void add(TextNode node) {
    if (open_.empty()) {
      root_ = std::move(node);
    } else if (expects_key()) {
      if (node.kind != TextNode::Kind::scalar) fail(node.line, "expected a plain word as key");
      open_.back().key = std::move(node);
    } else {
      OpenNode& parent = open_.back();
      if (parent.key) {
        node.key = parent.key->text;
        node.line = parent.key->line;
        parent.key.reset();
      }
      parent.node.children.push_back(std::move(node));
    }
  }

  [[noreturn]] void fail(int line, const std::string& expected) const {
    throw_file_fault(file_, line, "rig", expected);
  }

  const std::string& file_;
  std::vector<OpenNode> open_;  // outermost first
  std::optional<TextNode> root_;
};

}  // namespace

TextNode parse_yaml(const std::string& text, const std::string& file) {
  TreeBuilder builder(file);
  std::istringstream stream(text);
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& error) {
    throw_file_fault(file, error.mark.is_null() ? 1 : error.mark.line + 1, "rig",
                     "expected YAML: " + error.msg);
  }
  return builder.take_root();
}

}  // namespace understory
