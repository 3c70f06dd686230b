#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <map>

#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"

namespace understory {

namespace fs = std::filesystem;

void add_calibration_options(CLI::App& command, CalibrationArguments& arguments) {
  command.add_option("--unit", arguments.unit, "of the calibration's translations: m, cm or mm")
      ->capture_default_str();
  command.add_option("--size", arguments.size,
                     "of the calibrated images, WxH in pixels, where the files do not tell");
  command.add_option("--depth", arguments.depth_m, "to look at, m (default: the rig file's, else 10)");
}

fs::path rig_path(const std::string& argument) {
  std::error_code ignored;
  if (fs::exists(argument, ignored)) return argument;
  const fs::path rigs = project_root() / "models" / "rigs";
  const bool is_name = !argument.empty() && argument.find_first_of("/.") == std::string::npos;
  if (const fs::path named = rigs / (argument + ".yaml"); is_name && fs::exists(named, ignored)) return named;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(rigs, ignored))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  throw ScenarioError(fmt::format("{}: expected a rig file, a calibration's file or folder, or one of: {}",
                                  argument, fmt::join(names, ", ")));
}

CalibrationOptions calibration_options(const CalibrationArguments& arguments) {
  const std::map<std::string, double> meters_per_unit{{"m", 1}, {"cm", 0.01}, {"mm", 0.001}};
  CalibrationOptions options;
  const auto unit = meters_per_unit.find(arguments.unit);
  if (unit == meters_per_unit.end())
    throw ScenarioError(fmt::format("--unit {}: expected m, cm or mm", arguments.unit));
  options.meters_per_unit = unit->second;
  options.detection_depth_m = arguments.depth_m;
  if (arguments.size.empty()) return options;
  const char* const end = arguments.size.data() + arguments.size.size();
  int width_px = 0, height_px = 0;
  const auto [cross, width_error] = std::from_chars(arguments.size.data(), end, width_px);
  const bool has_cross = width_error == std::errc() && cross != end && *cross == 'x';
  const auto [stop, height_error] = std::from_chars(has_cross ? cross + 1 : end, end, height_px);
  if (!has_cross || height_error != std::errc() || stop != end)
    throw ScenarioError(fmt::format("--size {}: expected WIDTHxHEIGHT in pixels: 376x240", arguments.size));
  options.width_px = width_px;
  options.height_px = height_px;
  return options;
}

}  // namespace understory
