#include "scenarios/config/keys.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <stdexcept>

#include "scenarios/config/config_reader.hpp"
#include "scenarios/config/config_writer.hpp"

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

}  // namespace

void require_sound_keys(const std::string& part, const AnyConfig& keys) try {
  const std::unique_ptr<AnyConfig> written = keys.clone(), read = keys.clone();
  KeyLister lister;
  visit_fields(lister, *written);
  for (const Key& key : lister.keys())
    if (key.name.empty() ||
        key.name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") !=
            std::string::npos)
      throw ScenarioError(
          fmt::format("{}: {}: a key's name must be letters, digits and '_'", part, key.name));
  ConfigWriter writer;
  visit_fields(writer, *written);
  if (!lister.keys().empty()) read_config(parse_yaml(writer.text(), part), *read);
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

void KeyLister::add(std::string_view name, std::string value, std::string range, std::string_view meaning) {
  Key key = key_of(prefix_ + std::string(name), meaning);
  key.value = std::move(value);
  key.range = std::move(range);
  keys_.push_back(std::move(key));
}

}  // namespace understory
