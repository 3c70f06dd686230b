#include "perception/io/text_file.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace understory {
namespace {

constexpr std::size_t maximum_bytes = 1 << 20;
constexpr std::size_t maximum_quote = 80;

/// What a file said may be anything: a message stays one line of moderate length.
std::string quotable(std::string text, std::size_t maximum) {
  for (char& character : text)
    if (static_cast<unsigned char>(character) < ' ' || character == '\x7f') character = ' ';
  if (text.size() > maximum) text = text.substr(0, maximum) + "...";
  return text;
}

}  // namespace

void throw_file_fault(const std::string& file, int line, const std::string& key,
                      const std::string& expected) {
  throw std::runtime_error(quotable(file, 4096) + (line > 0 ? ":" + std::to_string(line) : "") + ": " +
                           quotable(key, maximum_quote) + ": " + quotable(expected, 5 * maximum_quote));
}

std::string read_text_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw_file_fault(file.string(), 0, "rig", "expected a file, this is a folder");
  std::ifstream stream(file, std::ios::binary);
  std::string text;
  std::array<char, 8192> piece;
  while (stream && text.size() <= maximum_bytes) {
    stream.read(piece.data(), piece.size());
    text.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.is_open() || stream.bad())
    throw_file_fault(file.string(), 0, "rig", "expected a readable file");
  if (text.size() > maximum_bytes)
    throw_file_fault(file.string(), 0, "rig", "expected a text file of at most 1 MiB");
  return text;
}

std::optional<double> finite_number(const std::string& text) {
  const bool has_plus = text.size() > 1 && text[0] == '+' && text[1] != '-';  // from_chars knows no plus
  const char* const end = text.data() + text.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data() + (has_plus ? 1 : 0), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace understory
