#include "scenarios/config/keys.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <memory>
#include <stdexcept>

#include "scenarios/config/any_config.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/config/field_writer.hpp"

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

class KeyLister : public FieldVisitor {
 public:
  explicit KeyLister(std::string prefix) : prefix_(std::move(prefix)) {}

  void truth(std::string_view name, bool& value, std::string_view meaning) override {
    add(name, value ? "true" : "false", "true | false", meaning);
  }
  void word(std::string_view name, std::string& value, std::string_view meaning) override {
    add(name, value, "a word", meaning);
  }
  void choice(std::string_view name, std::size_t& chosen, const std::vector<std::string>& words,
              std::string_view meaning) override {
    add(name, chosen < words.size() ? words[chosen] : "", fmt::format("{}", fmt::join(words, " | ")),
        meaning);
  }
  void words(std::string_view name, std::vector<std::string>& values, std::string_view meaning) override {
    add(name, fmt::format("[{}]", fmt::join(values, ", ")), "[words]", meaning);
  }
  void numbers(std::string_view name, FieldNumbers& numbers, std::string_view meaning) override {
    add(name, value_text(numbers),
        number_text(numbers, numbers.minimum) + " .. " + number_text(numbers, numbers.maximum), meaning);
    if (numbers.shape == Shape::optional) return;
    Key& key = keys.back();
    key.numbers = numbers.values;
    key.minimum = numbers.minimum;
    key.maximum = numbers.maximum;
    key.whole = numbers.whole;
  }
  void seed(std::string_view name, std::uint64_t& value, std::uint64_t maximum,
            std::string_view meaning) override {
    add(name, fmt::format("{}", value), fmt::format("0 .. {}", maximum), meaning);
  }
  void group(std::string_view name, const Fields& fields) override { list_below(std::string(name), fields); }
  void list(std::string_view name, const FieldList& list) override {
    list_below(std::string(name) + "[]", [&](FieldVisitor& visit) { list.visit(visit, list.size); });
  }

  std::vector<Key> keys;

 private:
  void list_below(const std::string& name, const Fields& fields) {
    const std::vector<Key> below = list_keys(fields, prefix_ + name + ".");
    keys.insert(keys.end(), below.begin(), below.end());
  }
  void add(std::string_view name, std::string value, std::string range, std::string_view meaning) {
    Key key = key_of(prefix_ + std::string(name), meaning);
    key.value = std::move(value);
    key.range = std::move(range);
    keys.push_back(std::move(key));
  }

  std::string prefix_;
};

void require_plain_keys(const std::string& part, const ConfigNode& map) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  for (const ConfigNode& node : map.children) {
    if (map.kind == ConfigNode::Kind::map &&
        (node.key.empty() || node.key.find_first_not_of(plain) != std::string::npos))
      throw ScenarioError(
          fmt::format("{}: {}: a key's name must be letters, digits and '_'", part, node.key));
    require_plain_keys(part, node);
  }
}

}  // namespace

void require_sound_keys(const std::string& part, const AnyConfig& keys) try {
  const std::unique_ptr<AnyConfig> written = keys.clone(), read = keys.clone();
  const std::string text = write_fields(fields_of(*written));
  if (text.empty()) return;
  const ConfigNode tree = parse_yaml(text, part);
  require_plain_keys(part, tree);
  read_config(tree, *read);
} catch (const InputError& error) {
  throw std::invalid_argument(error.what());
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

std::vector<Key> list_keys(const Fields& fields, const std::string& prefix) {
  KeyLister lister(prefix);
  fields(lister);
  return lister.keys;
}

}  // namespace understory
