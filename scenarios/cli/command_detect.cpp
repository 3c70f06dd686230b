#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "scenarios/cli/commands.hpp"
#include "scenarios/detect/detection_run.hpp"

namespace understory {
namespace {

struct DetectArguments : CalibrationArguments {
  DetectionOptions options;
  std::vector<std::string> inputs;
  std::string rig;
  std::string rule = "robust";
  std::string rectify = "nearest";
  std::string poses;
  std::string out = "detections";
};

/// One line of a terminal, gone with it: nothing stays before a complaint or the summary.
struct ProgressLine {
  bool shown = isatty(STDOUT_FILENO) == 1;
  ~ProgressLine() {
    if (!shown) return;
    fmt::print("\r\033[K");
    std::fflush(stdout);
  }
};

void print_progress(const DetectionProgress& progress) {
  fmt::print("\r\033[K{} of {} frames  {} hits  {:.1f} frames/s", progress.frames, progress.frames_expected,
             progress.hits,
             progress.wall_s > 0 ? static_cast<double>(progress.frames) / progress.wall_s : 0.0);
  std::fflush(stdout);
}

DetectionOptions options_of(const DetectArguments& arguments) {
  DetectionOptions options = arguments.options;
  options.inputs.assign(arguments.inputs.begin(), arguments.inputs.end());
  if (!arguments.rig.empty()) options.rig = rig_path(arguments.rig);
  options.calibration = calibration_options(arguments);
  options.rule = arguments.rule == "paper" ? paper_rule() : robust_rule();
  options.interpolation = arguments.rectify == "bilinear" ? Interpolation::bilinear : Interpolation::nearest;
  options.poses = arguments.poses;
  options.output_folder = arguments.out;
  return options;
}

DetectionResult detect(DetectionOptions options) {
  const ProgressLine progress;
  if (progress.shown) options.on_progress = print_progress;
  return run_detection(options);
}

int run_detect(const DetectArguments& arguments) {
  fmt::print("{}", to_report(detect(options_of(arguments))));
  return exit_goal;
}

}  // namespace

void add_detect_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<DetectArguments>();
  CLI::App* command = app.add_subcommand("detect", "find obstacles in recorded stereo images");
  command
      ->add_option("INPUT", arguments->inputs,
                   "a EuRoC folder; a left and a right folder of images; a left and a right image; or a "
                   "side-by-side video")
      ->required()
      ->expected(1, 2);
  command->add_option("--rig", arguments->rig,
                      "rig or calibration: a file, a folder, or a name in models/rigs (default: the EuRoC "
                      "folder's own)");
  add_calibration_options(*command, *arguments);
  command->add_option("--rectify", arguments->rectify, "raw images to the nearest pixel or bilinear")
      ->capture_default_str()
      ->check(CLI::IsMember({"nearest", "bilinear"}));
  command->add_option("--rule", arguments->rule, "paper or robust")
      ->capture_default_str()
      ->check(CLI::IsMember({"paper", "robust"}));
  command
      ->add_option("--set", arguments->options.settings,
                   "key=value of the detector or the map: depths_m=[10.1,7,5] (several depths at once), "
                   "pushbroom.minimum_edge_sum=300, map.max_age_s=10")
      ->allow_extra_args(false)
      ->trigger_on_parse(false);
  command->add_option("--poses", arguments->poses,
                      "poses of the body: TUM (t tx ty tz qx qy qz qw) or EuRoC ground truth; makes map.ply");
  command->add_option("--out", arguments->out, "folder for what is found")->capture_default_str();
  command->add_flag("--video", arguments->options.video, "one film instead of a picture per frame");
  command->callback([arguments, &chosen] { chosen = [arguments] { return run_detect(*arguments); }; });
}

}  // namespace understory
