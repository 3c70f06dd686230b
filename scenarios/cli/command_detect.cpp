#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/detect/detection_run.hpp"
#include "scenarios/scenario/rule_preset.hpp"

namespace understory {
namespace {

constexpr std::array<std::pair<std::string_view, Interpolation>, 2> interpolation_names{
    {{"nearest", Interpolation::nearest}, {"bilinear", Interpolation::bilinear}}};
/// Without the tuned rule, which is of one rig.
constexpr std::array<std::pair<std::string_view, RulePreset>, 2> detect_rule_names{
    {{"paper", RulePreset::paper}, {"robust", RulePreset::robust}}};

struct DetectArguments : CalibrationArguments {
  DetectionOptions options;
  std::vector<std::string> inputs;
  std::string rig;
  RulePreset rule = RulePreset::robust;
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
  options.rule = arguments.rule == RulePreset::paper ? paper_rule() : robust_rule();
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
  command.choice("--rule", arguments->rule, detect_rule_names, "which numbers the detector starts from");
  command.texts("--set", "KEY=VALUE", arguments->options.settings,
                "of the detector or the map: depths_m=[10.1,7,5] (several depths at once), "
                "pushbroom.minimum_edge_sum=300, map.max_age_s=10");
  command.text("--poses", "FILE", arguments->poses,
               "poses of the body: TUM (t tx ty tz qx qy qz qw) or EuRoC ground truth; makes map.ply");
  command.text("--out", "FOLDER", arguments->out, "for what is found");
  command.flag("--video", arguments->options.video, "one film instead of a picture per frame");
  command.runs([arguments] { return run_detect(*arguments); });
}

}  // namespace understory
