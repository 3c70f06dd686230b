#include "perception/io/field_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "perception/io/text_file.hpp"
#include "perception/io/text_table.hpp"

namespace understory {
namespace {

class FieldReader : public FieldVisitor {
 public:
  FieldReader(const TextNode& map, std::string path, Keys keys)
      : map_(map), path_(std::move(path)), keys_(keys) {}

  void truth(std::string_view name, bool& value, std::string_view) override {
    const TextNode* node = take(name);
    if (node == nullptr) return;
    if (node->text != "true" && node->text != "false") refuse(*node, name, "true or false");
    value = node->text == "true";
  }

  void word(std::string_view name, std::string& value, std::string_view) override {
    const TextNode* node = take(name);
    if (node == nullptr) return;
    if (node->kind != TextNode::Kind::scalar) refuse(*node, name, "a word");
    value = node->text;
  }

  void choice(std::string_view name, std::size_t& chosen, const std::vector<std::string>& words,
              std::string_view) override {
    const TextNode* node = take(name);
    if (node == nullptr) return;
    const auto found = std::ranges::find(words, node->text);
    if (node->kind != TextNode::Kind::scalar || found == words.end())
      refuse(*node, name, fmt::format("{}", fmt::join(words, " | ")), did_you_mean(node->text, words));
    chosen = static_cast<std::size_t>(found - words.begin());
  }

  void numbers(std::string_view name, FieldNumbers& numbers, std::string_view) override {
    const TextNode* node = take(name, numbers.shape != Shape::optional);
    if (node == nullptr) return;
    numbers.values.clear();
    if (numbers.shape == Shape::optional && node->kind == TextNode::Kind::nothing) return;
    if (numbers.shape == Shape::one || numbers.shape == Shape::optional) {
      numbers.values.push_back(number(*node, name, numbers));
      return;
    }
    const bool three = numbers.shape == Shape::three;
    if (node->kind != TextNode::Kind::list || (three && node->children.size() != 3))
      refuse(*node, name, three ? "a list of three numbers [x, y, z]" : "a list of numbers [a, b, ...]");
    for (const TextNode& child : node->children) numbers.values.push_back(number(child, name, numbers));
  }

  void seed(std::string_view name, std::uint64_t& value, std::uint64_t maximum, std::string_view) override {
    const TextNode* node = take(name);
    if (node == nullptr) return;
    const auto number = is_plain(*node) ? number_in<std::uint64_t>(node->text) : std::nullopt;
    if (!number || *number > maximum)
      refuse(*node, name, fmt::format("a whole number from 0 to {}", maximum));
    value = *number;
  }

  void words(std::string_view name, std::vector<std::string>& values, std::string_view meaning) override {
    const TextNode* node = take(name);
    if (node == nullptr) return;
    meaning = meaning.substr(0, meaning.find(": "));  // the words, without what each does
    const bool is_list = node->kind == TextNode::Kind::list;
    const std::vector<TextNode> given = is_list ? node->children : std::vector{*node};
    values.clear();
    for (const TextNode& word : given) {
      if (word.kind != TextNode::Kind::scalar || word.text.empty()) refuse(word, name, meaning);
      values.push_back(word.text);
    }
  }

  void tree(std::string_view name, TextNode& value, std::string_view) override {
    if (const TextNode* node = take(name)) value = *node;
  }

  void group(std::string_view name, const Fields& fields) override {
    if (const TextNode* node = take(name)) read_group(*node, name, fields);
  }

  void list(std::string_view name, const FieldList& list) override {
    const TextNode* node = take(name);
    if (node == nullptr) return;
    if (node->kind != TextNode::Kind::list) refuse(*node, name, "a list of groups [{...}, ...]");
    list.resize(node->children.size());  // a list is given whole: no entry outlives an earlier one
    for (std::size_t i = 0; i < node->children.size(); ++i)
      read_group(node->children[i], fmt::format("{}[{}]", name, i),
                 [&](FieldVisitor& visit) { list.visit(visit, i); });
  }

  void refuse_unknown() const {
    for (const TextNode& child : map_.children)
      if (std::ranges::find(known_, child.key) == known_.end())
        refuse_input(child.origin, full(child.key), "unknown key" + did_you_mean(child.key, known_));
  }

 private:
  const TextNode* take(std::string_view name, bool can_be_required = true) {
    known_.emplace_back(name);
    const TextNode* node = find_child(map_, name);
    if (node == nullptr && can_be_required && keys_ == Keys::all_required)
      refuse_input(map_.origin, full(name), "missing");
    return node;
  }

  void read_group(const TextNode& node, std::string_view name, const Fields& fields) {
    if (node.kind != TextNode::Kind::map) refuse(node, name, "a group of keys");
    read_fields(node, fields, full(name), keys_);
  }

  std::string full(std::string_view name) const {
    return path_.empty() ? std::string(name) : fmt::format("{}.{}", path_, name);
  }

  static bool is_plain(const TextNode& node) { return node.kind == TextNode::Kind::scalar && !node.quoted; }

  double number(const TextNode& node, std::string_view name, const FieldNumbers& numbers) const {
    std::optional<double> value;
    if (is_plain(node) && numbers.whole) value = number_in<std::int64_t>(node.text);
    if (is_plain(node) && !numbers.whole) value = number_in(node.text);
    if (!value || *value < numbers.minimum || *value > numbers.maximum)
      refuse(node, name,
             fmt::format("a {}number from {} to {}", numbers.whole ? "whole " : "",
                         number_text(numbers, numbers.minimum), number_text(numbers, numbers.maximum)));
    return *value;
  }

  [[noreturn]] void refuse(const TextNode& node, std::string_view name, std::string_view expected,
                           std::string_view hint = "") const {
    std::string got = node.text;
    if (node.kind == TextNode::Kind::nothing) got = "nothing";
    if (node.kind == TextNode::Kind::list) got = fmt::format("a list of {}", node.children.size());
    if (node.kind == TextNode::Kind::map) got = "a group of keys";
    refuse_input(node.origin, full(name), fmt::format("expected {}, got {}{}", expected, got, hint));
  }

  const TextNode& map_;
  std::string path_;
  Keys keys_;
  std::vector<std::string> known_;
};

/// `name` as it is called now, where it has changed since version 0.1: keys, options and values.
std::string renamed(std::string name) {
  static const std::map<std::string, std::string, std::less<>> whole{
      {"rule", "preset"},      {"--rule", "--preset"},      {"paper", "original"},      {"plain", "nominal"},
      {"gate_m", "opening_m"}, {"--no-film", "--no-video"}, {"--max-drop", "--margin"},
  };
  if (const auto found = whole.find(name); found != whole.end()) return found->second;
  for (const auto& [before, now] : {std::pair{"least", "minimum"}, std::pair{"greatest", "maximum"}})
    if (const auto at = name.find(before); at != std::string::npos)
      name.replace(at, std::strlen(before), now);
  return name;
}

}  // namespace

void read_fields(const TextNode& map, const Fields& fields, const std::string& path, Keys keys) {
  FieldReader reader(map, path, keys);
  fields(reader);
  reader.refuse_unknown();
}

std::string number_text(const FieldNumbers& numbers, double value) {
  return numbers.whole ? fmt::format("{:.0f}", value) : fmt::format("{}", value);
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  std::string best = renamed(std::string(word));
  if (std::ranges::find(known, best) == known.end()) best.clear();
  std::size_t best_distance = !best.empty() ? 0 : std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& name : known)
    if (best.empty() && word.size() > 4 && name.starts_with(word)) best = name, best_distance = 1;
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
