#include <fmt/format.h>

#include <memory>

#include "perception/io/calibration_file.hpp"
#include "perception/io/picture_codecs.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/detect/rig_figures.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

struct RigArguments : CalibrationArguments {
  std::string rig;
  std::string out;  // empty: no picture
};

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
  const std::vector<unsigned char> bytes = picture_codecs().encode(file.extension().string(), picture);
  write_whole_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

int run_rig(const RigArguments& arguments) {
  const fs::path out = arguments.out;
  if (!out.empty() && out.extension() != ".png" && out.extension() != ".jpg")
    throw ScenarioError(fmt::format("--out {}: expected a .png or .jpg", arguments.out));
  require_writable(out);
  const CalibratedRig calibrated = read(arguments);
  const RigFigures figures = rig_figures(calibrated.rig, PushbroomConfig());
  if (!arguments.out.empty()) write_picture(arguments.out, draw_rig(calibrated.rig, figures));
  fmt::print("{}", to_report(calibrated, figures));
  if (!arguments.out.empty()) fmt::print("  {:<20}{}\n", "picture", arguments.out);
  return 0;
}

}  // namespace

void add_rig_command(CommandLine& line) {
  const auto arguments = std::make_shared<RigArguments>();
  Command& command = line.add({"rig", "show what a calibration means: disparities, depths, views",
                               "understory rig long --out rig.png"});
  command
      .text("FILE", "RIG", arguments->rig,
            "a rig file, OpenCV XML or YAML, a folder of them, a EuRoC folder, or a name in models/rigs")
      .required();
  add_calibration_options(command, *arguments);
  command.text("--out", "FILE", arguments->out, "draw the rig from above into this .png or .jpg");
  command.runs([arguments] { return run_rig(*arguments); });
}

}  // namespace understory
