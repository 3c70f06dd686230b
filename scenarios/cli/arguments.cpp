#include "scenarios/cli/arguments.hpp"
#include "scenarios/scenario/plugin.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <thread>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/text_table.hpp"
#include "scenarios/campaign/gate.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<std::string_view, double>, 3> meters_per_unit{
    {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}}};

/// "minimum_clearance_m=0.1"
Tolerance tolerance_of(const std::string& word) {
  const std::size_t at = word.find('=');
  const auto loss = at == std::string::npos ? std::nullopt : number_in(word.substr(at + 1));
  if (!loss || *loss < 0)
    throw ScenarioError(
        fmt::format("--tolerate {}: expected FIGURE=LOSS, for example minimum_clearance_m=0.1", word));
  return {word.substr(0, at), *loss};
}

}  // namespace

void add_settings_option(Command& command, std::vector<std::string>& settings) {
  command.texts("--set", "KEY=VALUE", settings,
                "override a key of the scenario, for example forest.length_m=30; repeatable");
  add_plugin_option(command);
}

void add_plugin_option(Command& command) {
  command.texts(
      "--plugin", "FILE", given_plugins(),
      "shared library or Python file with detectors, planners, state sources or courses of your own, which "
      "keys can then name (docs/integrate.md); repeatable");
}

void add_with_option(Command& command, std::vector<std::string>& with) {
  command.texts(
      "--with", "FILE", with,
      "YAML file of keys and values to override, for example best.yaml written by tune; repeatable");
}

void add_vision_options(Command& command, VisionConfigSources& sources) {
  command.choice("--preset", sources.preset, pushbroom_preset_names,
                 "parameter set of the pushbroom detector: tuned (found by search for this rig), woods "
                 "(found by search in woods), robust (before tuning) or original (Barry & Tedrake 2015)");
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

void add_recording_options(Command& command, const std::string& name, RecordingChoice& choice,
                           const std::string& meaning) {
  command.choice(name, choice.form, recording_forms, meaning);
  command.whole("--every", choice.every, 1, 10'000, "record every N-th stereo pair only");
}

void add_jobs_option(Command& command, int& jobs, const std::string& what) {
  command.whole("--jobs", jobs, 1, 1024, "number of " + what + " at a time (default: number of cores)");
}

int jobs_or_cores(int jobs) {
  return jobs > 0 ? jobs : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void add_calibration_options(Command& command, CalibrationArguments& arguments) {
  command.text("--unit", "UNIT", arguments.unit,
               "unit of the lengths in a calibration of OpenCV or ROS: m (default), cm, mm, or a number of "
               "metres, for example 0.025 where they are counted in squares of a chessboard");
  command.text("--size", "WxH", arguments.size,
               "image size that the calibration is for, for example 376x240, if its files do not state it");
  command.number("--depth", arguments.depth_m, 0.1, 1000,
                 "detection depth in metres (default: the rig file's, else 10)");
}

CalibrationOptions calibration_options(const CalibrationArguments& arguments) {
  CalibrationOptions options;
  if (!arguments.unit.empty()) {
    const auto named =
        std::ranges::find(meters_per_unit, arguments.unit, [](const auto& one) { return one.first; });
    options.meters_per_unit =
        named != meters_per_unit.end() ? named->second : number_in<double>(arguments.unit);
    if (!options.meters_per_unit)
      throw ScenarioError(fmt::format("--unit {}: must be m, cm, mm or a number of metres, for example 0.025",
                                      arguments.unit));
  }
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

void add_rule_options(Command& command, GateRule& rule, std::vector<std::string>& tolerances) {
  command.number(
      "--margin", rule.margin, 0.001, 0.5,
      "fall of the success rate that must be ruled out for a change to pass: 0.05 is 5 percentage points");
  command.number(
      "--alpha", rule.alpha, 0.001, 0.3,
      "how many harmless changes may be called worse, and how many that cost the margin not worse");
  command.texts(
      "--tolerate", "FIGURE=LOSS", tolerances,
      "also judge the mean of mean_speed_mps, minimum_clearance_m, position_error_mean_m or progress_m, "
      "which may get worse by LOSS, for example mean_speed_mps=0.2; repeatable");
}

GateRule rule_of(GateRule rule, const std::vector<std::string>& tolerances) {
  for (const std::string& word : tolerances) rule.tolerances.push_back(tolerance_of(word));
  require_known_figures(rule);
  return rule;
}

}  // namespace understory
