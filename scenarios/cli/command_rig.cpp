#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>

#include "perception/io/calibration_file.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config_tree.hpp"
#include "scenarios/file_output.hpp"
#include "scenarios/rig_figures.hpp"
#include "scenarios/rig_picture.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

struct RigArguments {
  std::string rig;
  std::string unit = "m";
  std::string size;  // empty: the file says it
  std::optional<double> depth_m;
  std::string out;  // empty: no picture
};

/// A path, or the name of one of the house's rigs.
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

CalibrationOptions calibration_options(const RigArguments& arguments) {
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

CalibratedRig read(const RigArguments& arguments) {
  const CalibrationOptions options = calibration_options(arguments);
  const fs::path path = rig_path(arguments.rig);
  try {
    return read_calibrated_rig(path, options);
  } catch (const std::runtime_error& error) {
    throw ScenarioError(error.what());
  }
}

void write_picture(const fs::path& file, const cv::Mat& picture) {
  if (file.extension() != ".png" && file.extension() != ".jpg")
    throw ScenarioError(fmt::format("--out {}: expected a .png or .jpg", file.string()));
  std::vector<unsigned char> bytes;
  cv::imencode(file.extension().string(), picture, bytes);
  write_whole_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

int run_rig(const RigArguments& arguments) {
  const CalibratedRig calibrated = read(arguments);
  const RigFigures figures = rig_figures(calibrated.rig, PushbroomConfig());
  if (!arguments.out.empty()) write_picture(arguments.out, draw_rig(calibrated.rig, figures));
  fmt::print("{}", to_report(calibrated, figures));
  if (!arguments.out.empty()) fmt::print("  {:<20}{}\n", "picture", arguments.out);
  return 0;
}

}  // namespace

void add_rig_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<RigArguments>();
  CLI::App* command = app.add_subcommand("rig", "show what a calibration means: disparities, depths, views");
  command
      ->add_option(
          "FILE", arguments->rig,
          "a rig file, OpenCV XML or YAML, a folder of them, a EuRoC folder, or a name in models/rigs")
      ->required();
  command->add_option("--unit", arguments->unit, "of the file's translations: m, cm or mm")
      ->capture_default_str();
  command->add_option("--size", arguments->size,
                      "of the images, WxH in pixels, where the file does not tell");
  command->add_option("--depth", arguments->depth_m, "to look at, m (default: the rig file's, else 10)");
  command->add_option("--out", arguments->out, "draw the rig from above into this .png or .jpg");
  command->callback([arguments, &chosen] { chosen = [arguments] { return run_rig(*arguments); }; });
}

}  // namespace understory
