#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_reader.hpp"
#include "scenarios/evaluation/evaluation.hpp"
#include "scenarios/evaluation/evaluation_files.hpp"
#include "scenarios/scenario/rule_preset.hpp"

namespace understory {

/// The keys of --set, named as in a scenario.
struct EvaluatedPerception {
  EvaluationSettings& settings;
};
struct EvaluatedAutopilot {
  EvaluationSettings& settings;
};
template <typename Visitor>
void visit_fields(Visitor& visit, EvaluatedPerception& perception) {
  visit("depths_m", perception.settings.rule.depths_m, 0.1, 1000.0);
  visit("pushbroom", perception.settings.rule);
  visit("stereo_bm", perception.settings.stereo_bm);
  visit("stereo_sgbm", perception.settings.stereo_sgbm);
  visit("compute", perception.settings.compute);
}
template <typename Visitor>
void visit_fields(Visitor& visit, EvaluatedAutopilot& autopilot) {
  visit("map", autopilot.settings.map);
}
template <typename Visitor>
void visit_fields(Visitor& visit, EvaluationSettings& settings) {
  EvaluatedPerception perception{settings};
  EvaluatedAutopilot autopilot{settings};
  visit("perception", perception);
  visit("autopilot", autopilot);
}

namespace {

namespace fs = std::filesystem;

struct EvaluateArguments {
  std::vector<std::string> inputs;
  RulePreset rule = RulePreset::tuned;
  std::vector<std::string> settings;
  std::vector<std::string> with;
  std::string out;
  int every = 1;
  int jobs = 0;
};

void print_progress(const EvaluationProgress& progress) {
  if (progress.frames % 20 != 0 && progress.frames != progress.frames_expected) return;
  const double rate = static_cast<double>(progress.frames) / std::max(progress.wall_s, 1e-9);
  fmt::print("\r\033[K{} of {} frames, {:.0f} s left", progress.frames, progress.frames_expected,
             static_cast<double>(progress.frames_expected - progress.frames) / rate);
  std::fflush(stdout);
}

/// The rig that a recording was made with, as its scenario names it; nothing where others recorded.
std::string rig_named_in(const fs::path& recording) {
  const fs::path file = recording / "scenario.yaml";
  if (!fs::exists(file)) return "";
  const ConfigNode scenario = parse_config_file(file);
  const auto rig = std::ranges::find(scenario.children, "rig", &ConfigNode::key);
  return rig == scenario.children.end() ? "" : rig->text;
}

EvaluationSettings settings_of(const EvaluateArguments& arguments, const std::string& rig) {
  EvaluationSettings settings;
  settings.rule = rule_of(arguments.rule, rig);
  settings.every = arguments.every;
  for (const std::string& file : arguments.with) read_config(parse_config_file(file), settings);
  for (const std::string& setting : arguments.settings) read_config(parse_assignment(setting), settings);
  return settings;
}

int run_evaluate(const EvaluateArguments& arguments) {
  EvaluationOptions options;
  settings_of(arguments, "");  // what is wrong with them shows before anything is recorded
  options.jobs = jobs_or_cores(arguments.jobs);
  fs::path out = arguments.out;
  std::error_code ignored;
  const bool is_suite = arguments.inputs.size() == 1 && fs::is_regular_file(arguments.inputs[0], ignored);
  if (out.empty()) out = fs::path("evaluations") / fs::path(arguments.inputs[0]).stem();
  if (is_suite)
    options.folders = record_suite(arguments.inputs[0], out / "recordings", options.jobs);
  else
    options.folders.assign(arguments.inputs.begin(), arguments.inputs.end());
  options.settings = settings_of(arguments, rig_named_in(options.folders.front()));
  const bool terminal = isatty(STDOUT_FILENO) == 1;
  if (terminal) options.on_progress = print_progress;
  Evaluation evaluation;
  try {
    evaluation = evaluate(options);
  } catch (...) {
    if (terminal) fmt::print("\r\033[K");
    throw;
  }
  if (terminal) fmt::print("\r\033[K");
  write_evaluation(evaluation, out);
  fmt::print("{}\nfiles: {}\n", evaluation_report(evaluation), out.string());
  return exit_goal;
}

}  // namespace

void add_evaluate_command(CommandLine& line) {
  const auto arguments = std::make_shared<EvaluateArguments>();
  Command& command =
      line.add({"evaluate", "judge detections against recorded truth, and against StereoBM as the paper did",
                "understory evaluate recordings/forest --out evaluations/forest"});
  command.texts("INPUT", "FILE", arguments->inputs,
                "EuRoC folders as `record` leaves them; or one file of what to record and evaluate", 1);
  command.choice("--rule", arguments->rule, rule_names,
                 "the rule in the table's first line (tuned: for the recordings' rig)");
  add_with_option(command, arguments->with);
  add_settings_option(command, arguments->settings);
  command.whole("--every", arguments->every, 1, 1000, "take every n-th frame");
  add_jobs_option(command, arguments->jobs, "recordings");
  command.text("--out", "FOLDER", arguments->out, "for the results (default: evaluations/NAME)");
  command.runs([arguments] { return run_evaluate(*arguments); });
}

}  // namespace understory
