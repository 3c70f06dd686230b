#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/bad_input.hpp"
#include "scenarios/flight/flight_identity.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/folder_mark.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/output/progress_line.hpp"
#include "scenarios/output/signals.hpp"
#include "scenarios/scenario/scenario_rig.hpp"
#include "scenarios/tuning/asked_tuning.hpp"
#include "scenarios/tuning/judge.hpp"
#include "scenarios/tuning/tune_report.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

struct TuneArguments {
  std::string file;
  std::string out;  // empty: results/tune-<name>
  RendererKind renderer = RendererKind::osmesa;
  int jobs = 0;  // 0: a core each
  bool resume = false;
  bool ask = false;
};

std::unique_ptr<Judge> judge_of_flights(const char* part, const std::vector<std::uint64_t>& seeds,
                                        const TuneFile& file, const TuneArguments& arguments,
                                        const fs::path& folder) {
  rig_of(file.scenario, data_root() / "models");  // before anything is flown: every flight would fail
  return flight_judge({folder / "flown" / part, seeds,
                       std::string(word_for(opened_renderer(arguments.renderer).kind)), file.timeout_s,
                       jobs_or_cores(arguments.jobs)});
}

/// The judge of training or validation data.
std::unique_ptr<Judge> judge_of(bool validation, const TuneFile& file, const TuneArguments& arguments,
                                const fs::path& folder) {
  if (file.over == TuningData::flights)
    return validation ? judge_of_flights("validation", file.validation_seeds, file, arguments, folder)
                      : judge_of_flights("training", file.training_seeds, file, arguments, folder);
  return bad_input_if_refused([&] {
    return vision_judge(validation ? file.validation_folders : file.training_folders, file.every,
                        jobs_or_cores(arguments.jobs));
  });
}

/// Answers another program, a line for a line, until its questions end.
int answer_questions(const TuneFile& file, const TuneArguments& arguments, const fs::path& folder) {
  std::unique_ptr<Judge> judges[2];
  AskedTuning tuning(file, [&](bool validation) -> Judge& {
    std::unique_ptr<Judge>& judge = judges[validation ? 1 : 0];
    if (judge == nullptr) judge = judge_of(validation, file, arguments, folder);
    return *judge;
  });
  fmt::print("{}\n", tuning.greeting());
  std::fflush(stdout);
  for (std::string question; std::getline(std::cin, question);) {
    fmt::print("{}\n", tuning.answer(question));
    std::fflush(stdout);
  }
  return exit_goal;
}

/// What decides the trials: flights' identity, or the recordings and what looks at them.
Identity identity_of(const TuneFile& file, RendererKind renderer) {
  if (file.over == TuningData::flights)
    return understory::identity_of({file.scenario}, data_root() / "models", opened_renderer(renderer));
  Identity identity{{"program", program_digest()}, {"libraries", mapped_libraries_digest()}};
  for (const auto* folders : {&file.training_folders, &file.validation_folders})
    for (const fs::path& folder : *folders)
      identity.emplace_back("recording " + folder.string(), digest_of_recording(folder));
  return identity;
}

void show(ProgressLine& line, const TuneFile& file, const TuneProgress& progress) {
  line.show(fmt::format("{} {} of {}, best {} {:.4g}", progress.part, progress.done, progress.of,
                        file.figures[file.objective.goals.front().figure], progress.best),
            progress.measured, progress.left);
}

int run_tune(const TuneArguments& arguments) {
  const fs::path tuning = library_file(arguments.file, "tunings", "tuning");
  const TuneFile file = load_tune_file(tuning, scenario_file);
  const fs::path folder =
      arguments.out.empty() ? fs::path("results") / ("tune-" + file.name) : fs::path(arguments.out);
  std::vector<fs::path> others{tuning};
  for (const auto* folders : {&file.training_folders, &file.validation_folders})
    others.insert(others.end(), folders->begin(), folders->end());
  require_separate({folder}, others);
  require_not_within(folder, others);
  if (arguments.ask && file.over == TuningData::recordings) return answer_questions(file, arguments, folder);
  std::unique_ptr<Judge> training, validation;
  const auto take_judges = [&] {
    training = judge_of(false, file, arguments, folder);
    validation = judge_of(true, file, arguments, folder);
  };
  if (file.over == TuningData::recordings) take_judges();  // they name what is wrong there
  FolderMark mark(folder, tuning_results, folder);
  const Identity identity = [&] {
    try {
      return identity_of(file, arguments.renderer);
    } catch (const ScenarioError& error) {
      throw ScenarioError(fmt::format("{}: {}", file.scenario_file.string(), error.what()));
    }
  }();
  prepare_tune_folder(mark, folder, file, arguments.resume, identity);
  if (arguments.ask) return answer_questions(file, arguments, folder);
  if (file.over == TuningData::flights) take_judges();
  std::unique_ptr<Judge> flights;
  if (!file.fly.empty()) flights = judge_of_flights("best", file.fly, file, arguments, folder);
  const StopSignals stop_signals;
  ProgressLine line;
  TuneOptions options;
  options.folder = folder;
  options.stop_asked = [&] { return stop_signals.asked(); };
  options.on_progress = [&](const TuneProgress& progress) { show(line, file, progress); };
  try {
    const Tuned tuned = tune(file, *training, *validation, options, flights.get());
    write_tune_report(folder, file, tuned, data_root());
    line.clear();
    fmt::print("{}{}", to_text(comparison_table(file, tuned)),
               tuned.keeps_limits ? "" : "no trial keeps the bounds\n");
    if (gains(file, tuned))
      fmt::print("tables, plots and best.yaml: {}\n", folder.string());
    else
      fmt::print("no trial is better than the scenario as it is: no best.yaml\ntables and plots: {}\n",
                 folder.string());
  } catch (const Stopped&) {
    throw Stopped(stop_signals.number(), fmt::format("{}: stopped; --resume goes on", folder.string()));
  }
  return exit_goal;
}

}  // namespace

void add_tune_command(CommandLine& line) {
  const auto arguments = std::make_shared<TuneArguments>();
  Command& command = line.add(
      {"tune", "search for the values of keys that give the best results on recordings or in flights",
       "understory tune long --out results/tuned",
       "the search is complete; best.yaml holds the best values, unless the scenario's own values are as "
       "good"});
  command
      .text("file", "FILE", arguments->file,
            "tuning file, or a name in scenarios/library/tunings (docs/tuning.md)")
      .required();
  command.text("--out", "FOLDER", arguments->out, "results folder (default: results/tune-NAME)");
  add_plugin_option(command);
  add_jobs_option(command, arguments->jobs, "flights or recordings");
  add_renderer_option(command, arguments->renderer);
  command.flag("--resume", arguments->resume, "continue the unfinished tuning in the results folder");
  command.flag(
      "--ask", arguments->ask,
      "answer another program's questions, a line of JSON each, instead of searching (docs/tuning.md)");
  command.runs([arguments] { return run_tune(*arguments); });
}

}  // namespace understory
