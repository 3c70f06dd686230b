#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/calibration/write_calibration.hpp"
#include "perception/perception_config.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/bad_input.hpp"
#include "scenarios/detect/detection_run.hpp"
#include "scenarios/detect/rig_figures.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/progress_line.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

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
    line.show(fmt::format("{} of {} frames, {} detections", frames, expected, hits),
              static_cast<std::size_t>(frames),
              static_cast<std::size_t>(std::max<std::int64_t>(0, expected - frames)));
  };
  const DetectionResult result = run_detection(options);
  line.clear();
  fmt::print("{}", to_report(result));
  return exit_goal;
}

constexpr std::array<std::pair<std::string_view, CalibrationForm>, 4> form_names{
    {{"rig", CalibrationForm::rig_file},
     {"opencv", CalibrationForm::opencv},
     {"kalibr", CalibrationForm::kalibr},
     {"ros", CalibrationForm::ros}}};

struct RigArguments : CalibrationArguments {
  std::string rig;
  std::string out;  // empty: nothing is written
  CalibrationForm form = CalibrationForm::rig_file;
};

/// Of a form without a mounting: what it does not say.
std::string lost_in(CalibrationForm form, const StereoRig& rig) {
  const bool is_usual = rig.T_body_camera.isApprox(T_body_camera_of(Eigen::Vector3d::Zero(), 0));
  return form == CalibrationForm::rig_file || is_usual
             ? ""
             : "this form does not say where the camera is mounted; --form rig does\n";
}

int run_rig(const RigArguments& arguments) {
  const fs::path out = arguments.out;
  const CalibrationOptions options = calibration_options(arguments);
  const fs::path path = rig_path(arguments.rig);
  require_separate({out}, {path});
  const bool is_picture = out.extension() == ".svg";
  if (is_picture || arguments.form != CalibrationForm::ros) require_writable(out);
  const CalibratedRig calibrated = bad_input_if_refused([&] { return read_calibrated_rig(path, options); });
  const RigFigures figures = rig_figures(calibrated.rig, PushbroomConfig());
  std::vector<CalibrationText> texts;
  if (is_picture)
    texts.push_back({out, to_svg(rig_plots(calibrated.rig, figures), 2)});
  else if (!out.empty())
    try {
      texts = calibration_texts(calibrated, arguments.form, out);
    } catch (const InputError& error) {
      const bool is_of_name = arguments.form == CalibrationForm::rig_file;  // a rig file has no other fault
      throw ScenarioError(
          fmt::format("--out {}{}", error.what(), is_of_name ? ", or in .svg for a drawing" : ""));
    }
  for (const CalibrationText& text : texts) {
    require_not_within(text.file, {path});  // nor may raw/NAME.xml be what was read
    if (text.file != out) prepare_output_folder(text.file.parent_path());
    write_whole_file(text.file, text.text);
  }
  fmt::print("{}", to_report(calibrated, figures));
  for (const CalibrationText& text : texts) fmt::print("  {:<20}{}\n", "written", text.file.string());
  if (!texts.empty() && !is_picture) fmt::print("{}", lost_in(arguments.form, calibrated.rig));
  return 0;
}

}  // namespace

void add_detect_command(CommandLine& line) {
  const auto arguments = std::make_shared<DetectArguments>();
  Command& command = line.add({"detect", "detect obstacles in recorded stereo images",
                               "understory detect left/ right/ --rig calibration/ --out detections",
                               "every stereo pair was processed"});
  command.texts("INPUT", "FILE", arguments->inputs,
                "EuRoC folder; folders of left and right images; a left and a right image; or a side-by-side "
                "video",
                1, 2);
  command.text("--rig", "RIG", arguments->rig,
               "rig file, calibration file or folder, or a name in models/rigs (default: the EuRoC folder's "
               "calibration)");
  add_calibration_options(command, *arguments);
  command.choice("--rectify", arguments->options.interpolation, interpolation_names,
                 "how raw images are rectified: nearest pixel or bilinear interpolation");
  add_vision_options(command, arguments->options.vision);
  add_plugin_option(command);
  command.text("--poses", "FILE", arguments->poses,
               "file of body poses, TUM (t tx ty tz qx qy qz qw) or EuRoC ground truth; with it, map.ply is "
               "written too");
  command.text("--out", "FOLDER", arguments->out, "results folder");
  command.flag("--video", arguments->options.video, "write one video instead of a picture per frame");
  command.runs([arguments] { return run_detect(*arguments); });
}

void add_rig_command(CommandLine& line) {
  const auto arguments = std::make_shared<RigArguments>();
  Command& command = line.add({"rig", "print what a calibration means: disparities, depths, fields of view",
                               "understory rig long --out rig.svg"});
  command
      .text("FILE", "RIG", arguments->rig,
            "rig file, calibration of OpenCV, Kalibr, ROS, KITTI or Middlebury, EuRoC folder, or a name in "
            "models/rigs")
      .required();
  add_calibration_options(command, *arguments);
  command.text(
      "--out", "FILE", arguments->out,
      "write the calibration in another form, or, where the name ends in .svg, a drawing of the rig from "
      "above and of the image columns that the detector compares");
  command.choice(
      "--form", arguments->form, form_names,
      "form of --out: a rig file (.yaml), which scenarios fly; OpenCV's (.xml, .yaml, .json); Kalibr's "
      "camchain (.yaml); ROS's camera_info (a folder)");
  command.runs([arguments] { return run_rig(*arguments); });
}

}  // namespace understory
