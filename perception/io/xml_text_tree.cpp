#include <algorithm>
#include <string_view>

#include "perception/io/text_file.hpp"
#include "perception/io/text_tree.hpp"

namespace understory {
namespace {

constexpr int maximum_depth = 16;  // a matrix is 3 deep
constexpr std::string_view blanks = " \t\r\n";

class XmlReader {
 public:
  XmlReader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  TextNode document() {
    if (text_.starts_with("\xEF\xBB\xBF")) skip(3);
    skip_miscellany();
    const TextNode root = element(0);
    if (root.key != "opencv_storage") fail("expected <opencv_storage>, found <" + root.key + ">");
    skip_miscellany();
    if (!text_.empty()) fail("expected nothing after </opencv_storage>");
    return root;
  }

 private:
  TextNode element(int depth) {
    if (depth > maximum_depth) fail("expected at most 16 elements in each other");
    TextNode node;
    node.line = line_;
    expect("<");
    node.key = name();
    if (attributes_end_empty(node)) return node;
    content(node, depth);
    const std::string end = "</" + node.key;
    if (!take(end) || (skip_blanks(), !take(">"))) fail("expected " + end + ">");
    classify(node);
    return node;
  }

  /// Reads up to and including ">" or "/>"; true for the latter.
  bool attributes_end_empty(TextNode& node) {
    while (true) {
      skip_blanks();
      if (take("/>")) return true;
      if (take(">")) return false;
      const std::string attribute = name();
      skip_blanks();
      expect("=");
      skip_blanks();
      const std::string quote(text_.substr(0, 1));
      if (quote != "\"" && quote != "'") fail("expected a quoted attribute");
      skip(1);
      const std::string value = up_to(quote, "the end of an attribute");
      if (attribute == "type_id") node.type = value;
    }
  }

  /// Children and words up to the closing tag; words become children without a key.
  void content(TextNode& node, int depth) {
    while (true) {
      skip_blanks();
      if (text_.empty()) fail("expected </" + node.key + ">, found the end of the file");
      if (text_.starts_with("</")) return;
      if (take("<!--")) {
        up_to("-->", "the end of a comment");
      } else if (text_.starts_with('<')) {
        node.children.push_back(element(depth + 1));
      } else {
        node.children.push_back(word());
      }
    }
  }

  /// A number, a bare word, or a text in quotes (as OpenCV writes strings with blanks).
  TextNode word() {
    TextNode node;
    node.kind = TextNode::Kind::scalar;
    node.line = line_;
    if (take("\"")) {
      node.text = up_to("\"", "the end of a text in quotes");
    } else {
      const std::size_t length = std::min(text_.find_first_of(" \t\r\n<"), text_.size());
      node.text = text_.substr(0, length);
      skip(length);
    }
    return node;
  }

  void classify(TextNode& node) const {
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
      throw_file_fault(file_, node.line, node.key, "expected elements or values, not both");
    }
  }

  std::string name() {
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.:";
    const std::size_t length = std::min(text_.find_first_not_of(letters), text_.size());
    if (length == 0) fail("expected a name of letters and digits");
    const std::string found(text_.substr(0, length));
    skip(length);
    return found;
  }

  void skip_miscellany() {
    while (true) {
      skip_blanks();
      if (take("<?")) {
        up_to("?>", "?>");
      } else if (take("<!--")) {
        up_to("-->", "the end of a comment");
      } else {
        return;
      }
    }
  }

  void skip_blanks() { skip(std::min(text_.find_first_not_of(blanks), text_.size())); }

  std::string up_to(const std::string& end, const std::string& what) {
    const std::size_t length = text_.find(end);
    if (length == std::string_view::npos) fail("expected " + what + ", found the end of the file");
    const std::string found(text_.substr(0, length));
    skip(length + end.size());
    return found;
  }

  bool take(std::string_view wanted) {
    const bool found = text_.starts_with(wanted);
    if (found) skip(wanted.size());
    return found;
  }

  void expect(const std::string& wanted) {
    if (!take(wanted)) fail("expected " + wanted);
  }

  void skip(std::size_t count) {
    line_ += static_cast<int>(std::count(text_.begin(), text_.begin() + count, '\n'));
    text_.remove_prefix(count);
  }

  [[noreturn]] void fail(const std::string& expected) const {
    throw_file_fault(file_, line_, "rig", "expected OpenCV's XML: " + expected);
  }

  std::string_view text_;  // what is still to be read
  const std::string& file_;
  int line_ = 1;
};

}  // namespace

TextNode parse_opencv_xml(const std::string& text, const std::string& file) {
  return XmlReader(text, file).document();
}

}  // namespace understory
