#include "scenarios/config/keys.hpp"

#include <cxxabi.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <memory>

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

const FieldText* find_field(std::string_view owner, std::string_view name) {
  const FieldText* within = nullptr;
  for (const FieldText& field : field_texts()) {
    if (owner != field.owner) continue;
    if (name == field.name) return &field;
    if (owner != field.type && within == nullptr) within = find_field(field.type, name);
  }
  return within;
}

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789.e+-") == std::string_view::npos;
}

/// Comments may begin with "m/s, 0..20: ", for readers of the header: takes that away and gives its unit.
std::string take_unit_and_range(std::string& meaning) {
  const std::size_t dots = meaning.find("..");
  if (dots == std::string::npos) return "";
  const std::size_t from = meaning.rfind(' ', dots), begin = from == std::string::npos ? 0 : from + 1;
  const std::size_t end = std::min(meaning.find_first_of(" :,", dots), meaning.size());
  std::string_view last = std::string_view(meaning).substr(dots + 2, end - dots - 2);
  if (last.ends_with('.')) last.remove_suffix(1);
  if (!is_number(std::string_view(meaning).substr(begin, dots - begin)) || !is_number(last)) return "";
  std::string unit;
  if (begin > 0) {
    if (begin < 3 || begin > 20 || meaning[begin - 2] != ',') return "";
    unit = meaning.substr(0, begin - 2);
  }
  meaning.erase(0, std::min(meaning.find_first_not_of(" :,.", end), meaning.size()));
  return unit;
}

/// Where the word that ends at `end` begins, and before it as long as words are names: "Barry & Tedrake ".
std::size_t begin_of_authors(const std::string& text, std::size_t end) {
  while (end > 1) {
    const std::size_t space = text.rfind(' ', end - 2);
    const std::size_t begin = space == std::string::npos ? 0 : space + 1;
    const std::string word = text.substr(begin, end - 1 - begin);
    const bool is_name = std::isupper(static_cast<unsigned char>(word[0])) != 0 && !word.ends_with('.');
    if (!is_name && word != "&" && word != "et" && word != "al." && word[0] != '(') return end;
    if (word[0] == '(') return begin + 1;
    end = begin;
  }
  return end;
}

/// The pages, standards and papers that a comment names.
std::string sources_in(const std::string& text) {
  std::string sources;
  const auto add = [&](const std::string& source) {
    if (sources.find(source) == std::string::npos) sources += (sources.empty() ? "" : "; ") + source;
  };
  for (std::size_t at = text.find("docs/"); at != std::string::npos; at = text.find("docs/", at + 1)) {
    std::size_t end = text.find(".md", at);
    end = end == std::string::npos ? text.find_first_of(" ),;", at) : end + 3;
    if (end < text.size() && text.compare(end, 2, " [") == 0) end = text.find(']', end) + 1;
    add(text.substr(at, end - at));
  }
  if (text.find("MIL-F-8785C") != std::string::npos) add("MIL-F-8785C");
  for (const char* century : {" 19", " 20"})
    for (std::size_t at = text.find(century); at != std::string::npos; at = text.find(century, at + 1)) {
      const std::string year = text.substr(at + 1, 4);
      const bool is_year = year.size() == 4 && year.find_first_not_of("0123456789") == std::string::npos &&
                           (at + 5 >= text.size() || std::isalnum(text[at + 5]) == 0);
      const std::size_t begin = begin_of_authors(text, at + 1);
      if (is_year && begin <= at) add(text.substr(begin, at + 5 - begin));
    }
  return sources;
}

}  // namespace

Key key_of_field(std::string owner, const std::string& name) {
  Key key{name, "", unit_of(name), ""};
  const FieldText* field = find_field(owner, name);
  if (field == nullptr) return key;
  key.meaning = field->meaning;
  key.source = sources_in(key.meaning);
  if (const std::string unit = take_unit_and_range(key.meaning); !unit.empty()) key.unit = unit;
  return key;
}

KeyLister::KeyLister(const std::type_info& owner, std::string prefix) : prefix_(std::move(prefix)) {
  const std::unique_ptr<char, void (*)(void*)> name(
      abi::__cxa_demangle(owner.name(), nullptr, nullptr, nullptr), std::free);
  owner_ = name.get();
  owner_.erase(0, owner_.rfind(':') + 1);
}

void KeyLister::add(std::string_view name, std::string value, std::string range) {
  Key key = key_of_field(owner_, std::string(name));
  key.name = prefix_ + key.name;
  key.value = std::move(value);
  key.range = std::move(range);
  keys_.push_back(std::move(key));
}

}  // namespace understory
