#include "scenarios/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "scenarios/output/errors.hpp"

namespace understory {
namespace {

/// RFC 4648, section 4.
std::string base64(std::string_view bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? letters[three >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// JSON for a place between tags, where "</script" would end it.
std::string without_tags(std::string json) {
  for (std::size_t at = json.find('<'); at != std::string::npos; at = json.find('<', at))
    json.replace(at, 1, "\\u003c");
  return json;
}

std::string block(std::string_view id, std::string_view type, std::string_view text) {
  if (text.empty()) return "";
  return fmt::format("<script type=\"{}\" id=\"{}\">{}</script>\n", type, id, text);
}

std::string with(std::string page, std::string_view mark, std::string_view content) {
  const std::size_t at = page.find(mark);
  if (at == std::string::npos) throw MachineError(fmt::format("the page's template holds no {}", mark));
  return page.replace(at, mark.size(), content);
}

/// The facts with the arrays' table in them.
std::string with_arrays(std::string facts, const PageArrays& arrays) {
  return facts.insert(facts.size() - 1, ",\"arrays\":" + arrays.table());
}

}  // namespace

void PageArrays::add(std::string_view name, std::string_view type, int components, std::size_t values,
                     std::span<const std::byte> bytes, float scale) {
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  table_ += fmt::format("{}{{\"name\":\"{}\",\"type\":\"{}\",\"components\":{},\"count\":{},\"offset\":{}",
                        table_.empty() ? "" : ",", name, type, components,
                        values / static_cast<std::size_t>(components), bytes_.size());
  table_ += scale == 1 ? "}" : fmt::format(",\"scale\":{}}}", scale);
  bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

void PageArrays::add(std::string_view name, int components, const std::vector<float>& values) {
  if (!rounded_) {
    add(name, "f32", components, values.size(), std::as_bytes(std::span(values)));
    return;
  }
  constexpr float largest = 32000;
  constexpr std::int16_t not_a_number = std::numeric_limits<std::int16_t>::min();
  float maximum = 0;
  for (const float value : values)
    if (std::isfinite(value)) maximum = std::max(maximum, std::abs(value));
  const float scale = maximum > 0 ? maximum / largest : 1;
  std::vector<std::int16_t> rounded;
  rounded.reserve(values.size());
  for (const float value : values)
    rounded.push_back(std::isfinite(value) ? static_cast<std::int16_t>(std::lround(value / scale))
                                           : not_a_number);
  add(name, "i16", components, values.size(), std::as_bytes(std::span(rounded)), scale);
}

std::string packed_part(const std::string& facts, const PageArrays& arrays) {
  const std::string json = with_arrays(facts, arrays);
  const auto length = static_cast<std::uint32_t>(json.size());
  std::string part(reinterpret_cast<const char*>(&length), sizeof length);
  part += json;
  part.resize((part.size() + 3) / 4 * 4);
  return part + arrays.bytes();
}

std::string page_html(const std::filesystem::path& data_root, const PageContent& content) {
  const std::filesystem::path file = data_root / "scenarios/report/page/built/page.html";
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw MachineError(fmt::format("{}: the page's program is missing", file.string()));
  std::string page{std::istreambuf_iterator<char>(stream), {}};
  std::string blocks =
      block("facts", "application/json", without_tags(with_arrays(content.facts, content.arrays))) +
      block("arrays", "text/plain", base64(content.arrays.bytes())) +
      block("film", "text/plain", base64(content.film)) + block("still", "text/plain", base64(content.still));
  for (const auto& [name, bytes] : content.parts) blocks += block(name, "text/plain", base64(bytes));
  page = with(std::move(page), "<!--DATA-->", blocks);
  return with(std::move(page), "<title>Understory</title>", fmt::format("<title>{}</title>", content.title));
}

}  // namespace understory
