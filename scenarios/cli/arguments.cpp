#include "scenarios/cli/arguments.hpp"
#include "scenarios/scenario/plugin.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <thread>

#include "perception/io/calibration_file.hpp"
#include "perception/io/text_table.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<std::string_view, double>, 3> meters_per_unit{
    {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}}};

bool has_data(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder / "models", ignored) && fs::is_directory(folder / "scenarios", ignored);
}

std::vector<std::string> yaml_names(const fs::path& folder) {
  std::error_code ignored;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

fs::path data_root() {
  if (const char* given = std::getenv("UNDERSTORY_ROOT")) {
    if (has_data(given)) return given;
    throw ScenarioError(
        fmt::format("UNDERSTORY_ROOT={}: must be a folder with models/ and scenarios/", given));
  }
  std::error_code ignored;
  for (fs::path folder = fs::read_symlink("/proc/self/exe", ignored); folder.has_relative_path();) {
    folder = folder.parent_path();
    if (has_data(folder / "share/understory")) return folder / "share/understory";
    if (has_data(folder)) return folder;
  }
  throw MachineError(
      "models/ and scenarios/ are missing: install them, or set UNDERSTORY_ROOT to their folder");
}

fs::path library_file(const std::string& argument, const char* folder, const char* noun) {
  std::error_code ignored;
  const bool is_folder = fs::is_directory(argument, ignored);  // may be called as a file of the library is
  if (!is_folder && fs::exists(argument, ignored)) return argument;
  const fs::path in_root = data_root() / argument;  // scenarios/library/forest.yaml, from any folder
  if (fs::is_regular_file(in_root, ignored)) return in_root;
  const bool is_name = argument.find('/') == std::string::npos && !argument.ends_with(".yaml");
  const fs::path library = data_root() / "scenarios" / folder, named = library / (argument + ".yaml");
  if (is_name && fs::exists(named, ignored)) return named;
  if (is_folder) throw ScenarioError(fmt::format("{}: must be a {} file, is a folder", argument, noun));
  if (!is_name) throw ScenarioError(fmt::format("{}: cannot read this {} file", argument, noun));
  const std::vector<std::string> names = yaml_names(library);
  throw ScenarioError(fmt::format("{}: no such {} file, and none in the library, which has: {}{}", argument,
                                  noun, fmt::join(names, ", "), did_you_mean(argument, names)));
}

std::vector<std::string> scenario_names() { return yaml_names(data_root() / "scenarios" / "library"); }

fs::path scenario_file(const std::string& argument) { return library_file(argument, "library", "scenario"); }

std::vector<std::string> rig_names() { return yaml_names(data_root() / "models" / "rigs"); }

fs::path rig_path(const std::string& argument) {
  std::error_code ignored;
  if (fs::exists(argument, ignored)) return argument;
  const bool is_name = argument.find_first_of("/.") == std::string::npos;
  const fs::path named = data_root() / "models" / "rigs" / (argument + ".yaml");
  if (is_name && fs::exists(named, ignored)) return named;
  throw ScenarioError(fmt::format("{}: no such rig file or calibration; rigs of the library: {}", argument,
                                  fmt::join(rig_names(), ", ")));
}

void add_settings_option(Command& command, std::vector<std::string>& settings) {
  command.texts("--set", "KEY=VALUE", settings,
                "override a key of the scenario, for example forest.length_m=30; repeatable");
  add_plugin_option(command);
}

void add_plugin_option(Command& command) {
  command.texts(
      "--plugin", "FILE", given_plugins(),
      "shared library with detectors, planners, state sources or courses of your own, which keys can "
      "then name (docs/integrate.md); repeatable");
}

void add_with_option(Command& command, std::vector<std::string>& with) {
  command.texts(
      "--with", "FILE", with,
      "YAML file of keys and values to override, for example best.yaml written by tune; repeatable");
}

void add_vision_options(Command& command, VisionConfigSources& sources) {
  command.choice("--preset", sources.preset, pushbroom_preset_names,
                 "parameter set of the pushbroom detector: tuned (found by search for this rig), robust "
                 "(before tuning) or original (Barry & Tedrake 2015)");
  add_with_option(command, sources.with);
  command.texts("--set", "KEY=VALUE", sources.settings,
                "override a key of perception or autopilot.map, for example perception.depths_m=[10.1,7,5]; "
                "repeatable");
}

void add_renderer_option(Command& command, RendererKind& renderer) {
  command.choice("--renderer", renderer, renderer_names,
                 "OpenGL backend: osmesa (CPU), egl (a GPU if there is one, else the CPU), auto (egl if "
                 "there is a GPU, else osmesa)");
}

void add_jobs_option(Command& command, int& jobs, const std::string& what) {
  command.whole("--jobs", jobs, 1, 1024, "number of " + what + " at a time (default: number of cores)");
}

int jobs_or_cores(int jobs) {
  return jobs > 0 ? jobs : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void add_calibration_options(Command& command, CalibrationArguments& arguments) {
  command.choice("--unit", arguments.meters_per_unit, meters_per_unit,
                 "unit of the lengths in the calibration");
  command.text("--size", "WxH", arguments.size,
               "image size that the calibration is for, for example 376x240, if its files do not state it");
  command.number("--depth", arguments.depth_m, 0.1, 1000,
                 "detection depth in metres (default: the rig file's, else 10)");
}

CalibrationOptions calibration_options(const CalibrationArguments& arguments) {
  CalibrationOptions options;
  options.meters_per_unit = arguments.meters_per_unit;
  options.detection_depth_m = arguments.depth_m;
  if (arguments.size.empty()) return options;
  const std::size_t cross = std::min(arguments.size.find('x'), arguments.size.size() - 1);
  options.width_px = number_in<int>(arguments.size.substr(0, cross));
  options.height_px = number_in<int>(arguments.size.substr(cross + 1));
  if (!options.width_px || !options.height_px)
    throw ScenarioError(
        fmt::format("--size {}: must be WIDTHxHEIGHT in pixels, for example 376x240", arguments.size));
  return options;
}

}  // namespace understory
