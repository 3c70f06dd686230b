#include "perception/io/text_tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <string_view>

#include "perception/io/text_file.hpp"

namespace understory {
namespace {

constexpr std::size_t maximum_depth = 16;  // far above what any file of keys needs
constexpr std::size_t maximum_nodes = 100'000;
const std::string too_deep = "lists and maps may be nested at most 16 deep";
const std::string too_many = "a file may hold at most 100,000 values";
const std::string not_a_map = "must be one YAML document with keys and values";

std::size_t count_of(const TextNode& node) {
  std::size_t count = 1;
  for (const TextNode& child : node.children) count += count_of(child);
  return count;
}

std::size_t depth_of(const TextNode& node) {
  std::size_t deepest = 0;
  for (const TextNode& child : node.children) deepest = std::max(deepest, depth_of(child));
  return deepest + 1;
}

/// What most often keeps a text from being YAML, and where, which its parser tells in its own words: a tab
/// that indents, a bracket or a quotation mark that is not closed.
struct YamlFault {
  int line = 0;  ///< 0: none of these
  std::string what;
};

YamlFault likely_fault(const std::string& text) {
  struct Open {
    char mark;
    int line;
  };
  constexpr std::string_view before_value = ":[{,-\n";
  std::vector<Open> open;
  int line = 1, quote_line = 0;
  bool is_indentation = true, is_comment = false;
  char quote = 0, before = '\n', last_word = '\n';  // the character before, and the last one that is no blank
  for (const char c : text) {
    const bool begins_value = before_value.find(last_word) != std::string_view::npos;
    if (quote != 0) {
      if (c == quote && (quote == '\'' || before != '\\')) quote = 0;
    } else if (!is_comment) {
      if (is_indentation && c == '\t' && open.empty())
        return {line, "a key is indented with a tab: YAML wants blanks"};
      if (c == '#' && (before == ' ' || before == '\n' || before == '\t')) is_comment = true;
      if ((c == '"' || c == '\'') && begins_value) {
        quote = c;
        quote_line = line;
      }
      if ((c == '[' || c == '{') && begins_value) open.push_back({c, line});
      if ((c == ']' || c == '}') && !open.empty()) open.pop_back();
    }
    is_indentation = c == '\n' || (is_indentation && (c == ' ' || c == '\t'));
    if (c == '\n') {
      ++line;
      is_comment = false;
    }
    before = c;
    if (!is_comment && c != ' ' && c != '\t') last_word = c;
  }
  if (quote != 0) return {quote_line, std::string("a text has no closing ") + quote};
  if (open.empty()) return {};
  return {open.back().line, std::string("expected a ") + (open.back().mark == '[' ? ']' : '}') +
                                " that closes the " + open.back().mark};
}

/// Builds the tree from the parser's events, because yaml-cpp's own loaders cannot be left alone with a
/// strange file: YAML::LoadAll (0.7) finds documents without end behind a stray comma, an alias that contains
/// itself makes a node without end, and aliases of aliases make more nodes than memory holds. Here all end at
/// the first event that a file of keys would not have.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& name, bool has_lines) : name_(name), has_lines_(has_lines) {}

  std::optional<TextNode> read(const std::string& text) {
    std::istringstream stream(text);
    text_ = &text;
    try {
      YAML::Parser parser(stream);
      while (parser.HandleNextDocument(*this)) {
      }
    } catch (const YAML::Exception& error) {
      refuse_likely_fault();
      refuse_input(place(error.mark), "", "not valid YAML (`key: value` on a line of its own): " + error.msg);
    }
    return std::move(root_);
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (root_) refuse_input(place(mark), "", not_a_map);
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(node_of(mark, "", TextNode::Kind::nothing), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto named = anchored_.find(anchor);
    if (named == anchored_.end())
      refuse_input(place(mark), "", "an alias must not refer to the value that contains it");
    if (open_.size() + depth_of(named->second) > maximum_depth) refuse_input(place(mark), "", too_deep);
    count(count_of(named->second), place(mark));
    add(named->second, 0);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    TextNode node = node_of(mark, tag, TextNode::Kind::scalar);
    node.text = value;
    node.quoted = tag == "!";
    add(std::move(node), anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(node_of(mark, tag, TextNode::Kind::list), anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(node_of(mark, tag, TextNode::Kind::map), anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct OpenNode {
    TextNode node;
    YAML::anchor_t anchor = 0;
    std::optional<TextNode> key;  ///< read, and its value not yet
  };

  std::string place(const YAML::Mark& mark) const {
    return has_lines_ ? place_in(name_, mark.is_null() ? 1 : mark.line + 1) : name_;
  }

  TextNode node_of(const YAML::Mark& mark, const std::string& tag, TextNode::Kind kind) {
    constexpr std::string_view standard = "tag:yaml.org,2002:";
    TextNode node;
    node.kind = kind;
    node.origin = place(mark);
    if (tag.starts_with(standard)) node.type = tag.substr(standard.size());
    count(1, node.origin);
    return node;
  }

  void count(std::size_t more, const std::string& place) {
    nodes_ += more;
    if (nodes_ > maximum_nodes) refuse_input(place, "", too_many);
  }

  void open(TextNode node, YAML::anchor_t anchor) {
    if (open_.size() >= maximum_depth) refuse_input(node.origin, "", too_deep);
    if (!open_.empty() && expects_key()) refuse_key(node);
    open_.push_back({std::move(node), anchor, std::nullopt});
  }

  void close() {
    OpenNode closed = std::move(open_.back());
    open_.pop_back();
    add(std::move(closed.node), closed.anchor);
  }

  bool expects_key() const { return open_.back().node.kind == TextNode::Kind::map && !open_.back().key; }

  void refuse_likely_fault() const {
    const YamlFault fault = likely_fault(*text_);
    if (fault.line > 0) refuse_input(has_lines_ ? place_in(name_, fault.line) : name_, "", fault.what);
  }

  [[noreturn]] void refuse_key(const TextNode& node) const {
    refuse_likely_fault();
    refuse_input(node.origin, "", "a key must be a plain word");
  }

  void add(TextNode node, YAML::anchor_t anchor) {
    if (anchor != 0) {
      count(count_of(node), node.origin);
      anchored_[anchor] = node;
    }
    if (open_.empty()) {
      root_ = std::move(node);
    } else if (expects_key()) {
      if (node.kind != TextNode::Kind::scalar) refuse_key(node);
      open_.back().key = std::move(node);
    } else {
      OpenNode& parent = open_.back();
      if (parent.key) {
        node.key = parent.key->text;
        node.origin = parent.key->origin;
        parent.key.reset();
      }
      parent.node.children.push_back(std::move(node));
    }
  }

  const std::string& name_;
  const std::string* text_ = nullptr;  ///< while it is read
  bool has_lines_;
  std::size_t nodes_ = 0;
  std::vector<OpenNode> open_;  // outermost first
  std::map<YAML::anchor_t, TextNode> anchored_;
  std::optional<TextNode> root_;
};

class XmlReader {
 public:
  XmlReader(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  TextNode document() {
    pugi::xml_document document;
    const auto read = document.load_buffer(text_.data(), text_.size(),
                                           pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
    if (!read) fail(read.offset, read.description());
    const pugi::xml_node root = document.first_child();
    if (root.type() != pugi::node_element || std::string_view(root.name()) != "opencv_storage")
      fail(root.offset_debug(), std::string("expected <opencv_storage>, found <") + root.name() + ">");
    if (const pugi::xml_node next = root.next_sibling())
      fail(next.offset_debug(), "nothing may follow </opencv_storage>");
    return element(root, 1);
  }

 private:
  /// Words in an element become children without a key, and a single one its text.
  TextNode element(const pugi::xml_node& xml, std::size_t depth) {
    TextNode node = node_at(xml.offset_debug());
    if (depth > maximum_depth) refuse_input(node.origin, "", too_deep);
    node.key = xml.name();
    node.type = xml.attribute("type_id").value();
    for (const pugi::xml_node& child : xml) {
      if (child.type() == pugi::node_element)
        node.children.push_back(element(child, depth + 1));
      else if (child.type() == pugi::node_pcdata)
        add_words(child, node);
      else
        fail(child.offset_debug(), "only elements and values may stand here");
    }
    classify(node);
    return node;
  }

  /// Numbers, bare words, or texts in quotes (as OpenCV writes strings with blanks).
  void add_words(const pugi::xml_node& xml, TextNode& node) {
    constexpr const char* blanks = " \t\r\n";
    const std::string_view words = xml.value();
    for (std::size_t at = words.find_first_not_of(blanks); at < words.size();
         at = words.find_first_not_of(blanks, at)) {
      TextNode word = node_at(xml.offset_debug() + static_cast<std::ptrdiff_t>(at));
      word.kind = TextNode::Kind::scalar;
      word.quoted = words[at] == '"';
      const std::size_t first = at + (word.quoted ? 1 : 0);
      const std::size_t end = std::min(words.find_first_of(word.quoted ? "\"" : blanks, first), words.size());
      word.text = words.substr(first, end - first);
      node.children.push_back(std::move(word));
      at = std::min(end + (node.children.back().quoted ? 1 : 0), words.size());
    }
  }

  static void classify(TextNode& node) {
    const auto is_word = [](const TextNode& child) { return child.key.empty(); };
    const auto is_item = [](const TextNode& child) { return child.key.empty() || child.key == "_"; };
    const std::vector<TextNode>& children = node.children;
    if (children.empty()) return;
    if (children.size() == 1 && is_word(children.front())) {
      node.kind = TextNode::Kind::scalar;
      node.text = std::move(node.children.front().text);
      node.children.clear();
    } else if (std::all_of(children.begin(), children.end(), is_item)) {
      node.kind = TextNode::Kind::list;
    } else if (std::none_of(children.begin(), children.end(), is_word)) {
      node.kind = TextNode::Kind::map;
    } else {
      refuse_input(node.origin, node.key, "holds elements and a value: only one of the two may stand here");
    }
  }

  /// Nodes come in the order of the text: lines are counted on from the last.
  TextNode node_at(std::ptrdiff_t offset) {
    TextNode node;
    node.origin = place(offset);
    if (++nodes_ > maximum_nodes) refuse_input(node.origin, "", too_many);
    return node;
  }

  std::string place(std::ptrdiff_t offset) {
    const std::ptrdiff_t end = std::clamp<std::ptrdiff_t>(offset, counted_, std::ssize(text_));
    line_ += static_cast<int>(std::count(text_.begin() + counted_, text_.begin() + end, '\n'));
    counted_ = end;
    return place_in(file_, line_);
  }

  [[noreturn]] void fail(std::ptrdiff_t offset, const std::string& what) {
    refuse_input(place(offset), "", "not valid XML of OpenCV: " + what);
  }

  const std::string& text_;
  const std::string& file_;
  std::size_t nodes_ = 0;
  std::ptrdiff_t counted_ = 0;  // up to here line_ is right
  int line_ = 1;
};

}  // namespace

const TextNode* find_child(const TextNode& map, std::string_view key) {
  const auto found = std::ranges::find(map.children, key, &TextNode::key);
  return found == map.children.end() ? nullptr : &*found;
}

void refuse_double_keys(const TextNode& node, const std::string& path) {
  std::set<std::string_view> seen;
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    const TextNode& child = node.children[i];
    const bool in_map = node.kind == TextNode::Kind::map;
    const std::string full = !in_map        ? path + "[" + std::to_string(i) + "]"
                             : path.empty() ? child.key
                                            : path + "." + child.key;
    if (in_map && !seen.insert(child.key).second) refuse_input(child.origin, full, "this key is given twice");
    if (!child.children.empty()) refuse_double_keys(child, full);
  }
}

TextNode parse_yaml(const std::string& text, const std::string& file) {
  std::optional<TextNode> root = TreeBuilder(file, true).read(text);
  if (!root || root->kind != TextNode::Kind::map) refuse_input(place_in(file, 1), "", not_a_map);
  refuse_double_keys(*root);
  return std::move(*root);
}

TextNode parse_yaml_value(const std::string& text, const std::string& origin, const std::string& key) {
  TextNode value = TreeBuilder(origin, false).read(text).value_or(TextNode{});
  value.origin = origin;
  refuse_double_keys(value, key);
  return value;
}

TextNode parse_keyed_lines(const std::string& text, const std::string& file, char separator) {
  const auto node_of = [](TextNode::Kind kind, const std::string& place) {
    TextNode node;
    node.kind = kind;
    node.origin = place;
    return node;
  };
  TextNode root = node_of(TextNode::Kind::map, file);
  std::istringstream stream(text);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string place = place_in(file, number);
    const std::size_t at = line.find(separator);
    if (at == std::string::npos)
      refuse_input(place, "", std::string("expected KEY") + separator + " and numbers");
    TextNode value = node_of(TextNode::Kind::list, place);
    std::ranges::replace_if(
        line, [](char c) { return c == '[' || c == ']' || c == ';'; }, ' ');
    std::istringstream words(line.substr(at + 1));
    for (std::string word; words >> word;) {
      value.children.push_back(node_of(TextNode::Kind::scalar, place));
      value.children.back().text = word;
    }
    if (value.children.size() == 1) value = TextNode(value.children.front());
    value.key = line.substr(0, at);
    root.children.push_back(std::move(value));
  }
  refuse_double_keys(root);
  return root;
}

TextNode parse_opencv_xml(const std::string& text, const std::string& file) {
  TextNode root = XmlReader(text, file).document();
  refuse_double_keys(root);
  return root;
}

}  // namespace understory
