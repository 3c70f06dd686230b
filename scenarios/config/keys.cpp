#include "scenarios/config/keys.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace understory {
namespace {

/// How a name's end says its unit; the longer ends first.
constexpr std::array<std::pair<std::string_view, std::string_view>, 34> units{
    {{"_n_per_mps", "N per m/s"},
     {"_m_per_n", "m/N"},
     {"_per_s", "1/s"},
     {"_hz_at_1n", "Hz"},
     {"_well_e", "electrons"},
     {"_gray", "gray levels"},
     {"_radpsps_rthz", "rad/s^2/sqrt(Hz)"},
     {"_mps2ps_rthz", "m/s^3/sqrt(Hz)"},
     {"_radps_rthz", "rad/s/sqrt(Hz)"},
     {"_mps2_rthz", "m/s^2/sqrt(Hz)"},
     {"_m_rts", "m/sqrt(s)"},
     {"_radpspn", "rad/s/N"},
     {"_nmspr", "N m s/rad"},
     {"_mps2pn", "m/s^2/N"},
     {"_percent", "%"},
     {"_radps", "rad/s"},
     {"_kgpm3", "kg/m^3"},
     {"_kgm2", "kg m^2"},
     {"_mps2", "m/s^2"},
     {"_mps", "m/s"},
     {"_rad", "rad"},
     {"_m2", "m^2"},
     {"_hz", "Hz"},
     {"_px", "px"},
     {"_ut", "uT"},
     {"_pa", "Pa"},
     {"_kg", "kg"},
     {"_ms", "ms"},
     {"_ns", "ns"},
     {"_mb", "MB"},
     {"_n", "N"},
     {"_m", "m"},
     {"_s", "s"},
     {"square_metres_per_tree", "m^2"}}};

std::string unit_of(std::string_view name) {
  for (const auto& [end, unit] : units)
    if (name.ends_with(end)) return std::string(unit);
  return "";
}

/// A visitor that lets only keys pass whose values can be written and read again.
struct KeyCheck {
  std::string part;
  std::vector<std::string> seen = {};

  void expect(bool holds, std::string_view name, const std::string& what) const {
    if (!holds) throw std::invalid_argument(fmt::format("key '{}.{}': {}", part, name, what));
  }
  void take(std::string_view name) {
    expect(!name.empty() &&
               std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) || c == '_'; }),
           name, "the name must be letters, digits and '_'");
    expect(std::ranges::find(seen, name) == seen.end(), name, "the name stands twice");
    seen.emplace_back(name);
  }
  void operator()(std::string_view name, bool&, std::string_view) { take(name); }
  void operator()(std::string_view name, std::string& word, std::string_view) {
    take(name);
    expect(std::ranges::none_of(word, [](unsigned char c) { return c < ' ' || c == 127; }), name,
           "must be one line");
  }
  void operator()(std::string_view name, std::string& word, const std::vector<std::string>& words,
                  std::string_view) {
    take(name);
    expect(std::ranges::find(words, word) != words.end(), name,
           fmt::format("must be {}, is {}", fmt::join(words, " | "), word));
  }
  template <typename Value, typename Bound>
  void operator()(std::string_view name, Value& value, Bound minimum, Bound maximum, std::string_view) {
    take(name);
    expect(std::isfinite(minimum) && std::isfinite(maximum) && minimum <= maximum, name,
           fmt::format("its bounds {} and {} must be finite, the smaller one first", minimum, maximum));
    const auto check = [&](double number) {
      expect(number >= minimum && number <= maximum, name,
             fmt::format("must be from {} to {}, is {}", minimum, maximum, number));
    };
    if constexpr (std::is_arithmetic_v<Value>)
      check(value);
    else
      for (const double number : value) check(number);
  }
};

}  // namespace

void require_sound_keys(const std::string& part, AnyConfig& keys) {
  KeyCheck check{part};
  visit_fields(check, keys);
}

Key key_of(std::string_view name, std::string_view text) {
  constexpr std::string_view mark = " | ";
  std::array<std::string, 3> parts;  // meaning, source, unit
  for (std::string& part : parts) {
    const std::size_t end = text.find(mark);
    part = text.substr(0, end);
    text = end == std::string_view::npos ? "" : text.substr(end + mark.size());
  }
  auto& [meaning, source, unit] = parts;
  return {std::string(name), "", unit.empty() ? unit_of(name) : unit, "", meaning, source};
}

void KeyLister::add(std::string_view name, std::string value, std::string range, std::string_view meaning) {
  Key key = key_of(prefix_ + std::string(name), meaning);
  key.value = std::move(value);
  key.range = std::move(range);
  keys_.push_back(std::move(key));
}

}  // namespace understory
