#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "scenarios/config/field_visitor.hpp"

namespace understory {

/// The visitor that writes a config struct as YAML, every field in its order. Numbers are written in the
/// fewest digits that read back exactly, so writing and reading again gives the same struct.
class ConfigWriter {
 public:
  template <typename T>
  void operator()(std::string_view name, T& field, std::string_view = {}) {
    if constexpr (std::is_same_v<T, bool>) {
      line(name, field ? "true" : "false");
    } else if constexpr (std::is_same_v<T, std::string>) {
      line(name, quoted(field));
    } else if constexpr (requires { field.emplace_back(); }) {  // a list of structs
      line(name, field.empty() ? "[]" : "");
      for (auto& entry : field) write_entry(entry);
    } else {
      line(name, "");
      indent_ += 2;
      visit_fields(*this, field);
      indent_ -= 2;
    }
  }

  template <typename T, typename Least, typename Greatest>
  requires std::is_arithmetic_v<Least>
  void operator()(std::string_view name, T& field, Least, Greatest, std::string_view = {}) {
    if constexpr (std::is_arithmetic_v<T>) {
      line(name, fmt::format("{}", field));
    } else if constexpr (requires { field.reset(); }) {  // std::optional
      line(name, field ? fmt::format("{}", *field) : "~");
    } else {
      std::string list;
      for (const auto value : field) list += fmt::format("{}{}", list.empty() ? "" : ", ", value);
      line(name, "[" + list + "]");
    }
  }

  template <typename T, std::size_t N>
  void operator()(std::string_view name, T& field, const std::array<std::pair<std::string_view, T>, N>& names,
                  std::string_view = {}) {
    for (const auto& [word, value] : names) {
      if (field == value) line(name, word);
    }
  }

  void operator()(std::string_view name, std::string& field, const std::vector<std::string>&,
                  std::string_view = {}) {
    line(name, field);
  }

  const std::string& text() const { return text_; }

 private:
  template <typename T>
  void write_entry(T& entry) {
    const std::size_t start = text_.size();
    indent_ += 4;
    visit_fields(*this, entry);
    indent_ -= 4;
    text_[start + static_cast<std::size_t>(indent_) + 2] = '-';  // in front of its first key
  }

  void line(std::string_view name, std::string_view value) {
    text_ += fmt::format("{:{}}{}:{}{}\n", "", indent_, name, value.empty() ? "" : " ", value);
  }

  static std::string quoted(const std::string& word) {
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

  std::string text_;
  int indent_ = 0;
};

/// `config` as YAML text.
template <typename Config>
std::string write_config(Config config) {  // by value: the visitors take fields they could change
  ConfigWriter writer;
  visit_fields(writer, config);
  return writer.text();
}

}  // namespace understory
