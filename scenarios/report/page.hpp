#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace understory {

/// A page's numbers as typed arrays, which a browser takes over without parsing: little endian, one behind
/// the other, each at a multiple of four bytes.
class PageArrays {
 public:
  /// `rounded`: floating-point numbers in 16 bits, at most 1/64,000 of an array's largest away.
  explicit PageArrays(bool rounded = false) : rounded_(rounded) {}

  /// `components` values belong together: 3 for a place.
  void add(std::string_view name, int components, const std::vector<float>& values);
  template <std::unsigned_integral Value>
  void add(std::string_view name, int components, const std::vector<Value>& values) {
    add(name,
        sizeof(Value) == 1   ? "u8"
        : sizeof(Value) == 2 ? "u16"
                             : "u32",
        components, values.size(), std::as_bytes(std::span(values)));
  }

  /// A JSON list: name, type, components, count, offset of each, and what rounded values are to be multiplied
  /// by.
  std::string table() const { return "[" + table_ + "]"; }
  const std::string& bytes() const { return bytes_; }

 private:
  void add(std::string_view name, std::string_view type, int components, std::size_t values,
           std::span<const std::byte> bytes, float scale = 1);

  bool rounded_;
  std::string table_, bytes_;
};

/// What a page shows.
struct PageContent {
  std::string title;
  std::string facts;  ///< a JSON object; scenarios/report/page/src/facts.ts says what is in it
  PageArrays arrays;
  std::string film;   ///< bytes of an mp4; empty: none
  std::string still;  ///< bytes of a JPEG; empty: none
  /// Parts that the page reads on demand: a name and bytes of packed_part().
  std::vector<std::pair<std::string, std::string>> parts;
};

/// Facts and arrays as one: the facts' length in 32 bits, the facts, filled up to a multiple of four bytes,
/// the arrays.
std::string packed_part(const std::string& facts, const PageArrays& arrays);

/// One HTML file that needs nothing else: the page's program, scenarios/report/page/built/page.html below
/// `data_root`, with the content put in. Throws MachineError where that file is not there.
std::string page_html(const std::filesystem::path& data_root, const PageContent& content);

}  // namespace understory
