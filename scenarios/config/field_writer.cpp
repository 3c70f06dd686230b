#include "scenarios/config/field_writer.hpp"

#include <fmt/format.h>

#include "perception/io/field_reader.hpp"

namespace understory {
namespace {

std::string in_quotes(const std::string& word) {
  std::string out = "\"";
  for (const char c : word) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n')
      out += "\\n";
    else
      out += c;
  }
  return out + "\"";
}

class FieldWriter : public FieldVisitor {
 public:
  void truth(std::string_view name, bool& value, std::string_view) override {
    line(name, value ? "true" : "false");
  }
  void word(std::string_view name, std::string& value, std::string_view) override {
    line(name, in_quotes(value));
  }
  void choice(std::string_view name, std::size_t& chosen, const std::vector<std::string>& words,
              std::string_view) override {
    if (chosen < words.size()) line(name, words[chosen]);
  }
  void numbers(std::string_view name, FieldNumbers& numbers, std::string_view) override {
    line(name, value_text(numbers));
  }
  void seed(std::string_view name, std::uint64_t& value, std::uint64_t, std::string_view) override {
    line(name, fmt::format("{}", value));
  }
  /// A list without words is left out: it cannot be read.
  void words(std::string_view name, std::vector<std::string>& values, std::string_view) override {
    std::string list;
    for (const std::string& word : values) list += (list.empty() ? "" : ", ") + in_quotes(word);
    if (!values.empty()) line(name, "[" + list + "]");
  }
  void group(std::string_view name, const Fields& fields) override {
    line(name, "");
    indent_ += 2;
    fields(*this);
    indent_ -= 2;
  }
  void list(std::string_view name, const FieldList& list) override {
    line(name, list.size == 0 ? "[]" : "");
    for (std::size_t i = 0; i < list.size; ++i) {
      const std::size_t start = text.size();
      indent_ += 4;
      list.visit(*this, i);
      indent_ -= 4;
      text[start + static_cast<std::size_t>(indent_) + 2] = '-';  // in front of its first key
    }
  }

  std::string text;

 private:
  void line(std::string_view name, std::string_view value) {
    text += fmt::format("{:{}}{}:{}{}\n", "", indent_, name, value.empty() ? "" : " ", value);
  }

  int indent_ = 0;
};

}  // namespace

std::string value_text(const FieldNumbers& numbers) {
  using Shape = FieldNumbers::Shape;
  std::string text;
  for (const double value : numbers.values) text += (text.empty() ? "" : ", ") + number_text(numbers, value);
  if (numbers.shape == Shape::three || numbers.shape == Shape::list) return "[" + text + "]";
  return text.empty() ? "~" : text;
}

std::string write_fields(const Fields& fields) {
  FieldWriter writer;
  fields(writer);
  return writer.text;
}

}  // namespace understory
