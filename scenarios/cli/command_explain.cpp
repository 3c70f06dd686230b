#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/explain/explain_report.hpp"
#include "scenarios/flight/flight_page.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/folder_mark.hpp"
#include "scenarios/output/progress_line.hpp"
#include "scenarios/output/signals.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

struct ExplainArguments {
  std::string folder;
  RendererKind renderer = RendererKind::osmesa;
  int jobs = 0, flights = 200;
};

Scenario scenario_of_run(const fs::path& run) {
  std::error_code ignored;
  for (const char* file : {"scenario.yaml", "result.json"})
    if (!fs::exists(run / file, ignored))
      throw ScenarioError(fmt::format("{}: not the folder of a run: {} is missing", run.string(), file));
  return load_scenario(run / "scenario.yaml");
}

/// The page without a film; one with a film stays, and `report` makes it anew.
void write_page(const ExplainedFlight& explained, const std::string& json, const fs::path& run,
                FolderMark& mark) {
  std::error_code ignored;
  if (fs::exists(run / "flight.mp4", ignored) && fs::exists(run / "report.html", ignored)) {
    fmt::print("understory report {} puts this on the page, beside the film\n", run.string());
    return;
  }
  mark.require_own("report.html");
  FlightPageExtras extras{data_root()};
  extras.chapter = explanation_chapter(explanation_from_json(json, "explain.json"));
  write_whole_file(run / "report.html", flight_page(explained.log, extras), &mark);
  fmt::print("page: {}\n", (run / "report.html").string());
}

int run_explain(const ExplainArguments& arguments) {
  const fs::path run = arguments.folder;
  const Scenario scenario = scenario_of_run(run);
  FolderMark mark(run, flight_results, run);
  mark.require_own("explain.json");
  const Unfinished work(run / ".explain");
  ExplainOptions options;
  options.models_folder = data_root() / "models";
  options.work_folder = work.path();
  options.renderer = arguments.renderer;
  options.jobs = jobs_or_cores(arguments.jobs);
  options.flights = arguments.flights;
  ProgressLine line;
  options.on_progress = [&](std::size_t flown, std::size_t asked) {
    line.show(fmt::format("{} of {} flights", flown, asked), flown, asked - flown);
  };
  const ExplainedFlight explained = explain_flight(scenario, options);
  line.clear();
  const std::vector<Evidence> evidence = evidence_in(explained.log);
  const Conclusion conclusion = conclusion_of(explained.explanation, evidence);
  const std::string json = to_json(explained, evidence, conclusion);
  write_whole_file(run / "explain.json", json, &mark);
  fmt::print("{}\n{}\n{}\n{}", conclusion.sentence, to_text(effects_table(explained.explanation)),
             to_text(chances_table(explained.explanation)),
             conclusion.disagreement.empty() ? "" : conclusion.disagreement + "\n");
  write_page(explained, json, run, mark);
  return exit_goal;
}

}  // namespace

void add_explain_command(CommandLine& line) {
  const auto arguments = std::make_shared<ExplainArguments>();
  Command& command =
      line.add({"explain", "find out why a flight was lost: which part of the stack, made ideal, saves it",
                "understory explain runs/paper-1008"});
  command.text("folder", "FOLDER", arguments->folder, "folder of a run whose flight was lost").required();
  command.whole("--flights", arguments->flights, 20, 10'000, "fly at most so many flights");
  add_jobs_option(command, arguments->jobs, "flights");
  add_renderer_option(command, arguments->renderer);
  command.runs([arguments] { return run_explain(*arguments); });
}

}  // namespace understory
