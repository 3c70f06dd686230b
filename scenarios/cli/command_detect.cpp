#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "perception/perception_config.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/detect/detection_run.hpp"
#include "scenarios/output/progress_line.hpp"

namespace understory {
namespace {

constexpr std::array<std::pair<std::string_view, Interpolation>, 2> interpolation_names{
    {{"nearest", Interpolation::nearest}, {"bilinear", Interpolation::bilinear}}};

struct DetectArguments : CalibrationArguments {
  DetectionOptions options;
  std::vector<std::string> inputs;
  std::string rig;
  std::string poses;
  std::string out = "detections";
};

int run_detect(const DetectArguments& arguments) {
  DetectionOptions options = arguments.options;
  options.inputs.assign(arguments.inputs.begin(), arguments.inputs.end());
  if (!arguments.rig.empty()) options.rig = rig_path(arguments.rig);
  options.calibration = calibration_options(arguments);
  options.poses = arguments.poses;
  options.output_folder = arguments.out;
  ProgressLine line;
  options.on_progress = [&](std::int64_t frames, std::int64_t expected, std::int64_t hits) {
    line.show(fmt::format("{} of {} frames, {} hits", frames, expected, hits),
              static_cast<std::size_t>(frames),
              static_cast<std::size_t>(std::max<std::int64_t>(0, expected - frames)));
  };
  const DetectionResult result = run_detection(options);
  line.clear();
  fmt::print("{}", to_report(result));
  return exit_goal;
}

}  // namespace

void add_detect_command(CommandLine& line) {
  const auto arguments = std::make_shared<DetectArguments>();
  Command& command = line.add({"detect", "find obstacles in recorded stereo images",
                               "understory detect left/ right/ --rig calibration/ --out detections",
                               "every pair was looked at"});
  command.texts("INPUT", "FILE", arguments->inputs,
                "a EuRoC folder; a left and a right folder of images; a left and a right image; or a "
                "side-by-side video",
                1, 2);
  command.text("--rig", "RIG", arguments->rig,
               "rig or calibration: a file, a folder, or a name in models/rigs (default: the EuRoC folder's "
               "own)");
  add_calibration_options(command, *arguments);
  command.choice("--rectify", arguments->options.interpolation, interpolation_names,
                 "raw images to the nearest pixel or bilinear");
  add_vision_options(command, arguments->options.vision);
  command.text("--poses", "FILE", arguments->poses,
               "poses of the body: TUM (t tx ty tz qx qy qz qw) or EuRoC ground truth; makes map.ply");
  command.text("--out", "FOLDER", arguments->out, "for what is found");
  command.flag("--video", arguments->options.video, "one film instead of a picture per frame");
  command.runs([arguments] { return run_detect(*arguments); });
}

}  // namespace understory
