#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/explain/explain_report.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/progress_line.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

struct ExplainArguments {
  std::string folder;
  RendererKind renderer = RendererKind::osmesa;
  int jobs = 0, flights = 200;
};

int run_explain(const ExplainArguments& arguments) {
  ProgressLine line;
  ExplainOptions options{.models_folder = data_root() / "models",
                         .work_folder = fs::path(arguments.folder) / "explain",
                         .renderer = arguments.renderer,
                         .jobs = jobs_or_cores(arguments.jobs),
                         .flights = arguments.flights};
  options.on_progress = [&](std::size_t flown, std::size_t asked) {
    line.show(fmt::format("{} of {} flights", flown, asked), flown, asked - flown);
  };
  const ExplainedFlight explained =
      explain_flight(load_scenario(fs::path(arguments.folder) / "scenario.yaml"), options);
  line.clear();
  const std::vector<Evidence> evidence = evidence_in(explained.log);
  const Conclusion conclusion = conclusion_of(explained.explanation, evidence);
  write_whole_file(fs::path(arguments.folder) / "explain.json", to_json(explained, evidence, conclusion));
  fs::remove_all(options.work_folder);
  fmt::print("{}\n{}\n{}\n{}{}{}\n", conclusion.sentence, to_text(effects_table(explained.explanation)),
             to_text(chances_table(explained.explanation)), conclusion.disagreement,
             conclusion.disagreement.empty() ? "" : "\n", explained.explanation.flights.size());
  return exit_goal;
}

}  // namespace

void add_explain_command(CommandLine& line) {
  const auto arguments = std::make_shared<ExplainArguments>();
  Command& command =
      line.add({"explain", "find out why a flight was lost: which part of the stack, made ideal, saves it",
                "understory explain runs/dense-1004"});
  command.text("RUN", "FOLDER", arguments->folder, "folder of a lost flight's results").required();
  command.whole("--flights", arguments->flights, 20, 10'000, "fly at most so many flights");
  add_jobs_option(command, arguments->jobs, "flights");
  add_renderer_option(command, arguments->renderer);
  command.runs([arguments] { return run_explain(*arguments); });
}

}  // namespace understory
