#include <fmt/format.h>

#include <memory>
#include <sstream>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/text_table.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/evaluation/evaluation.hpp"
#include "scenarios/evaluation/evaluation_report.hpp"
#include "scenarios/evaluation/evaluation_suite.hpp"
#include "scenarios/evaluation/pair_evaluation.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/output_folder.hpp"
#include "scenarios/output/progress_line.hpp"
#include "scenarios/scenario/plugin.hpp"

namespace understory {

namespace {

namespace fs = std::filesystem;

struct EvaluateArguments {
  std::vector<std::string> inputs;
  VisionConfigSources vision;
  std::string out;
  std::vector<std::string> detectors, disparities, curves;
  int every = 1;
  int jobs = 0;
  bool pairs = false;
};

/// "edges", a plug-in's; or "tuned=best.yaml", what this file's keys describe.
std::vector<ComparedDetector> detectors_of(const EvaluateArguments& arguments, const std::string& rig) {
  std::vector<ComparedDetector> detectors;
  for (const std::string& given : arguments.detectors) {
    const std::size_t at = given.find('=');
    const std::string name = given.substr(0, at);
    VisionConfigSources sources = arguments.vision;
    if (at != std::string::npos) sources.with.push_back(given.substr(at + 1));
    const VisionConfig config = read_vision_config(sources, rig);
    const std::string part_name = at == std::string::npos ? name : config.detector;
    const DetectorPart* part = parts().detectors.find(part_name);
    if (part == nullptr)
      throw ScenarioError(fmt::format("--detector {}: there is no such detector{}{}", name,
                                      did_you_mean(name, parts().detectors.names()),
                                      given_plugins().empty() ? "; --plugin loads others" : ""));
    if (!names_a_folder(name) || !part->needs_images || (part->plugin.empty() && at == std::string::npos))
      throw ScenarioError(fmt::format(
          "--detector {}: expected a plug-in's detector, or NAME=FILE with a file of keys whose "
          "perception.detector uses images and a NAME without '/' and without '.' first; Understory's own "
          "detectors are compared anyway",
          given));
    detectors.push_back({name, part_name, config});
  }
  return detectors;
}

/// "perception.edges.uniqueness=1.1,1.5,2"
CurveSettings curve_of(const std::string& given, const std::vector<ComparedDetector>& detectors,
                       const VisionConfigSources& vision, const std::string& rig) {
  const std::size_t at = given.find('='), dot = given.rfind('.', at);
  const std::string expected = "expected perception.DETECTOR.KEY=VALUE,VALUE,... from lax to strict";
  if (at == std::string::npos || dot == std::string::npos || !given.starts_with("perception.") || dot < 11)
    throw ScenarioError(fmt::format("--curve {}: {}", given, expected));
  CurveSettings curve{given.substr(11, dot - 11), given.substr(dot + 1, at - dot - 1), {}};
  std::vector<std::string> names{"pushbroom", "stereo_bm", "stereo_sgbm"};
  for (const ComparedDetector& one : detectors) names.push_back(one.part);
  if (std::ranges::find(names, curve.detector) == names.end())
    throw ScenarioError(fmt::format("--curve {}: no detector {} is compared here{}; --detector adds others",
                                    given, curve.detector, did_you_mean(curve.detector, names)));
  std::istringstream values(given.substr(at + 1));
  for (std::string value; std::getline(values, value, ',');) {
    const auto number = number_in(value);
    if (!number) throw ScenarioError(fmt::format("--curve {}: {}", given, expected));
    VisionConfigSources sources = vision;
    sources.settings.push_back(given.substr(0, at + 1) + value);
    curve.points.emplace_back(*number, read_vision_config(sources, rig));
  }
  if (curve.points.size() < 2) throw ScenarioError(fmt::format("--curve {}: {}", given, expected));
  return curve;
}

/// Pairs with true disparities, without a calibration: a table.
void run_pairs(const EvaluateArguments& arguments, EvaluationSettings settings, const fs::path& out) {
  const StereoRig rig = read_calibrated_rig(rig_path("long"), {}).rig;
  static_cast<VisionConfig&>(settings) = read_vision_config(arguments.vision, rig.name);
  settings.more_detectors = detectors_of(arguments, rig.name);
  std::vector<ImagePair> pairs;
  std::size_t expected = 0, done = 0;
  for (const std::string& folder : arguments.inputs)
    for (ImagePair& pair : read_image_pairs(folder, arguments.every)) {
      expected += whole_disparities(pair, rig).size();
      if (arguments.inputs.size() > 1) pair.name = recording_name(folder);
      pairs.push_back(std::move(pair));
    }
  OutputFolder output(out, evaluation_results, "", Replace::anything);
  ProgressLine line;
  const std::vector<PairScore> scores = evaluate_pairs(pairs, settings, rig, [&] {
    ++done;
    line.show(fmt::format("{} of {} disparities", done, expected), done, expected - done);
  });
  line.clear();
  const Table table = pair_table(scores);
  prepare_output_folder(output.path() / "tables");
  write_whole_file(output.path() / "tables/pairs.csv", to_csv(table));
  write_whole_file(output.path() / "summary.md", "# Pairs\n\n" + to_markdown(table));
  output.finish();
  fmt::print("{}\nfiles: {}\n", to_text(table), out.string());
}

int run_evaluate(EvaluateArguments arguments) {
  EvaluationOptions options;
  arguments.vision.one_depth = true;  // full stereo is cropped to one depth's interval, to be compared
  // What is wrong there shows before anything is recorded.
  if (const std::string detector = read_vision_config(arguments.vision, "").detector; detector != "pushbroom")
    throw ScenarioError(
        "perception.detector: must be pushbroom here; --detector NAME=FILE adds another, got " + detector);
  options.settings.more_detectors = detectors_of(arguments, "");
  for (const std::string& given : arguments.curves)
    curve_of(given, options.settings.more_detectors, arguments.vision, "");
  for (const std::string& given : arguments.disparities)
    options.settings.disparities.push_back(disparity_folder_of(given));
  EvaluationSum().make_room(options.settings);
  options.jobs = jobs_or_cores(arguments.jobs);
  fs::path out = arguments.out;
  std::error_code ignored;
  if (arguments.inputs.size() == 1 && !fs::is_directory(arguments.inputs[0], ignored))
    arguments.inputs[0] = library_file(arguments.inputs[0], "evaluations", "evaluation").string();
  const bool is_suite = arguments.inputs.size() == 1 && fs::is_regular_file(arguments.inputs[0], ignored);
  if (out.empty()) {
    const fs::path input = fs::absolute(arguments.inputs[0]).lexically_normal();  // "rec/", "."
    out = fs::path("evaluations") / (input.has_filename() ? input : input.parent_path()).stem();
  }
  require_separate({out}, {arguments.inputs.begin(), arguments.inputs.end()});
  if (arguments.pairs) {
    if (!arguments.disparities.empty() || !arguments.curves.empty())
      throw ScenarioError("--pairs: takes no --disparities or --curve");
    run_pairs(arguments, options.settings, out);
    return exit_goal;
  }
  OutputFolder output(out, evaluation_results, "", Replace::anything);
  if (is_suite)
    options.folders = record_suite(arguments.inputs[0], out / "recordings", options.jobs, scenario_file,
                                   data_root() / "models");
  else
    options.folders.assign(arguments.inputs.begin(), arguments.inputs.end());
  const std::string rig = rig_named_in(options.folders.front());
  static_cast<VisionConfig&>(options.settings) = read_vision_config(arguments.vision, rig);
  options.settings.more_detectors = detectors_of(arguments, rig);
  options.settings.every = arguments.every;
  for (const std::string& given : arguments.curves)
    options.settings.curves.push_back(
        curve_of(given, options.settings.more_detectors, arguments.vision, rig));
  ProgressLine line;
  options.on_progress = [&](std::int64_t frames, std::int64_t expected) {
    line.show(fmt::format("{} of {} frames", frames, expected), static_cast<std::size_t>(frames),
              static_cast<std::size_t>(expected - frames));
  };
  const Evaluation evaluation = evaluate(options);
  line.clear();
  write_evaluation(evaluation, output.path(), data_root());
  output.finish();
  fmt::print("{}\nfiles: {}\n", evaluation_report(evaluation), out.string());
  return exit_goal;
}

}  // namespace

void add_evaluate_command(CommandLine& line) {
  const auto arguments = std::make_shared<EvaluateArguments>();
  Command& command = line.add(
      {"evaluate",
       "compare detections with the recorded ground truth, and with StereoBM as in Barry & Tedrake 2015",
       "understory evaluate recordings/forest --out evaluations/forest"});
  command.texts("INPUT", "FILE", arguments->inputs,
                "folders written by record, in EuRoC layout; or one evaluation file, or its name in "
                "scenarios/library/evaluations",
                1);
  add_vision_options(command, arguments->vision);
  add_plugin_option(command);
  command.texts("--detector", "NAME[=FILE]", arguments->detectors,
                "also compare this detector of a plug-in, or under NAME the detector that a file of keys "
                "describes, for example best.yaml written by tune; repeatable");
  command.texts("--curve", "KEY=VALUES", arguments->curves,
                "also draw precision over recall for these values of a detector's key, for example "
                "perception.stereo_bm.texture_threshold=0,200,400; repeatable");
  command.texts(
      "--disparities", "NAME=FOLDER", arguments->disparities,
      "disparities of another program for each pair, PFM or 16-bit PNG in 1/256 px, named as the left "
      "images (docs/evaluate.md); repeatable");
  command.flag("--pairs", arguments->pairs,
               "the folders hold pairs with true disparities instead (KITTI's, Middlebury's, ETH3D's; "
               "docs/evaluate.md): score the detectors at each whole disparity; several folders are scenes");
  command.whole("--every", arguments->every, 1, 1000, "use every N-th frame only");
  add_jobs_option(command, arguments->jobs, "recordings");
  command.text("--out", "FOLDER", arguments->out, "results folder (default: evaluations/NAME)");
  command.runs([arguments] { return run_evaluate(*arguments); });
}

}  // namespace understory
