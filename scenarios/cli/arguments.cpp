#include "scenarios/cli/arguments.hpp"

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
        fmt::format("UNDERSTORY_ROOT={}: expected a folder with models/ and scenarios/", given));
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

std::vector<std::string> scenario_names() { return yaml_names(data_root() / "scenarios" / "library"); }

fs::path scenario_file(const std::string& argument) {
  std::error_code ignored;
  const bool is_folder =
      fs::is_directory(argument, ignored);  // may be called as a scenario of the library is
  if (!is_folder && fs::exists(argument, ignored)) return argument;
  const fs::path in_root = data_root() / argument;  // scenarios/library/forest.yaml, from any folder
  if (fs::is_regular_file(in_root, ignored)) return in_root;
  const bool is_name = argument.find('/') == std::string::npos && !argument.ends_with(".yaml");
  const fs::path named = data_root() / "scenarios" / "library" / (argument + ".yaml");
  if (is_name && fs::exists(named, ignored)) return named;
  if (is_folder) throw ScenarioError(fmt::format("{}: expected a scenario file, this is a folder", argument));
  const std::vector<std::string> names = scenario_names();
  throw ScenarioError(fmt::format("{}: expected a scenario file, or one of the library: {}{}", argument,
                                  fmt::join(names, ", "), did_you_mean(argument, names)));
}

std::vector<std::string> rig_names() { return yaml_names(data_root() / "models" / "rigs"); }

fs::path rig_path(const std::string& argument) {
  std::error_code ignored;
  if (fs::exists(argument, ignored)) return argument;
  const bool is_name = argument.find_first_of("/.") == std::string::npos;
  const fs::path named = data_root() / "models" / "rigs" / (argument + ".yaml");
  if (is_name && fs::exists(named, ignored)) return named;
  throw ScenarioError(fmt::format("{}: expected a rig file, a calibration's file or folder, or one of: {}",
                                  argument, fmt::join(rig_names(), ", ")));
}

void add_settings_option(Command& command, std::vector<std::string>& settings) {
  command.texts("--set", "KEY=VALUE", settings, "as in the scenario file: forest.length_m=30");
}

void add_with_option(Command& command, std::vector<std::string>& with) {
  command.texts("--with", "FILE", with, "keys that go over the scenario's own: what tune leaves");
}

void add_vision_options(Command& command, VisionConfigSources& sources) {
  command.choice("--preset", sources.preset, pushbroom_preset_names,
                 "the thresholds of the pushbroom detector; tuned: those of the recordings' rig");
  add_with_option(command, sources.with);
  command.texts("--set", "KEY=VALUE", sources.settings,
                "of perception and autopilot.map, as in a scenario file: perception.depths_m=[10.1,7,5], "
                "perception.pushbroom.minimum_edge_sum=300, autopilot.map.max_age_s=10");
}

void add_renderer_option(Command& command, RendererKind& renderer) {
  command.choice("--renderer", renderer, renderer_names,
                 "who draws: software, a GPU where there is one, a GPU or else osmesa");
}

void add_jobs_option(Command& command, int& jobs, const std::string& what) {
  command.whole("--jobs", jobs, 1, 1024, what + " at a time (default: one a core)");
}

int jobs_or_cores(int jobs) {
  return jobs > 0 ? jobs : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void add_calibration_options(Command& command, CalibrationArguments& arguments) {
  command.choice("--unit", arguments.meters_per_unit, meters_per_unit, "of the calibration's translations");
  command.text("--size", "WxH", arguments.size,
               "of the calibrated images in pixels, where the files do not tell");
  command.number("--depth", arguments.depth_m, 0.1, 1000, "to look at, m (default: the rig file's, else 10)");
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
    throw ScenarioError(fmt::format("--size {}: expected WIDTHxHEIGHT in pixels: 376x240", arguments.size));
  return options;
}

}  // namespace understory
