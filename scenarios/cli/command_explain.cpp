#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/explain/explain_campaign.hpp"
#include "scenarios/explain/explain_report.hpp"
#include "scenarios/flight/flight_page.hpp"
#include "scenarios/flight/fly.hpp"
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
  int jobs = 0, flights = 170, first_seed = 1;
};

Scenario scenario_of_flown_run(const fs::path& run) {
  std::error_code ignored;
  if (!fs::is_directory(run, ignored))
    throw ScenarioError(fmt::format("{}: {}; expected the folder of a run or of a campaign", run.string(),
                                    fs::exists(run, ignored) ? "this is a file" : "there is no such folder"));
  for (const char* file : {"scenario.yaml", "result.json"})
    if (!fs::exists(run / file, ignored))
      throw ScenarioError(
          fmt::format("{}: not the folder of a run ({} is missing), nor of a campaign "
                      "(campaign.json is missing)",
                      run.string(), file));
  return load_scenario(run / "scenario.yaml");
}

/// The page without a film; one with a film stays, and `report` makes it anew.
void write_page(const ExplainedFlight& explained, const fs::path& run, const std::string& warning,
                FolderMark& mark) {
  std::error_code ignored;
  if (fs::exists(run / "flight.mp4", ignored) && fs::exists(run / "report.html", ignored)) {
    fmt::print("understory report {} puts this on the page, beside the film\n", run.string());
    return;
  }
  mark.require_own("report.html");
  FlightPageExtras extras{data_root()};
  extras.warning = warning;
  extras.chapter = explanation_chapter(explained.told);
  write_whole_file(run / "report.html", flight_page(explained.log, extras), &mark);
  fmt::print("page: {}\n", (run / "report.html").string());
}

/// The one with this index of `count` lost flights.
ExplainedFlight explained_flight(const Scenario& scenario, const fs::path& work,
                                 const ExplainArguments& asked, ProgressLine& line, std::size_t index = 0,
                                 std::size_t count = 1) {
  const auto most = static_cast<std::size_t>(asked.flights);
  const std::string title = count > 1 ? fmt::format("lost flight {} of {}: ", index + 1, count) : "";
  return explain_flight(scenario, {.models_folder = data_root() / "models",
                                   .work_folder = work,
                                   .renderer = asked.renderer,
                                   .jobs = jobs_or_cores(asked.jobs),
                                   .first_seed = asked.first_seed,
                                   .flights = asked.flights,
                                   .on_progress = [&](std::size_t flown) {
                                     line.show(fmt::format("{}{} of at most {} flights", title, flown, most),
                                               index * most + flown,
                                               (count - index) * most - std::min(flown, most));
                                   }});
}

int explain_run(const ExplainArguments& arguments) {
  const fs::path run = arguments.folder;
  const Scenario scenario = scenario_of_flown_run(run);
  const RunResult result = result_of_run(run);
  if (result.reached_goal)
    throw ScenarioError(
        fmt::format("{}: this flight reached its goal; only a lost flight is explained", run.string()));
  FolderMark mark(run, flight_results, run);
  mark.require_own("explain.json");
  const Unfinished work(run / ".explain");
  ProgressLine line;
  const ExplainedFlight explained = explained_flight(scenario, work.path(), arguments, line);
  write_whole_file(run / "explain.json", to_json(explained), &mark);
  const auto& [why, conclusion, evidence] = explained.told;
  fmt::print("{}\n{}\n{}\n{}", conclusion.sentence, to_text(effects_table(why)), to_text(chances_table(why)),
             conclusion.disagreement.empty() ? "" : conclusion.disagreement + "\n");
  const std::string warning = warning_of_digest(explained.log.result, result.digest);
  if (!warning.empty()) fmt::print("{}\n", warning);
  write_page(explained, run, warning, mark);
  return exit_goal;
}

int run_explain(const ExplainArguments& arguments) {
  if (!holds_campaign(arguments.folder)) return explain_run(arguments);
  if (arguments.first_seed != 1)
    throw ScenarioError(
        "--first-seed: is for the folder of a run; fly a campaign's flight again to explain it twice");
  explain_campaign(arguments.folder, arguments.renderer, arguments.jobs, arguments.flights);
  return exit_goal;
}

}  // namespace

void explain_campaign(const fs::path& path, RendererKind renderer, int jobs, int flights) {
  const CampaignFolder folder{path};
  const Campaign campaign = read_campaign(folder);
  std::vector<FlightRow> lost = gather(folder, campaign).rows;
  if (std::ranges::none_of(lost, &FlightRow::flown))
    throw ScenarioError(fmt::format("{}: none of its flights is flown yet", path.string()));
  std::erase_if(lost, [](const FlightRow& row) {
    return !row.flown() || row.reached_goal() || row.outcome == word_for(Outcome::time);
  });
  if (word_for(renderer) != campaign.renderer)
    throw ScenarioError(fmt::format("{}: was drawn with --renderer {}; other images are other flights",
                                    path.string(), campaign.renderer));
  prepare_output_folder(folder.path / "explained");
  std::vector<FlightRow> asked = lost;
  std::error_code ignored;
  std::erase_if(asked,
                [&](const FlightRow& row) { return fs::exists(folder.explanation_file(row.id), ignored); });
  if (asked.empty() && !lost.empty())
    fmt::print("all {} lost flights are explained; delete {} to explain one again\n", lost.size(),
               folder.explanation_file("FLIGHT").string());
  ProgressLine line;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const FlightRow& row = asked[i];
    const auto condition = std::ranges::find(campaign.conditions, row.condition, &Condition::name);
    const Scenario scenario =
        scenario_from_text(condition->scenario_text, condition->name, {fmt::format("seed={}", row.seed)});
    const Unfinished work(folder.path / ".explain");
    const ExplainedFlight explained = [&] {
      try {
        return explained_flight(scenario, work.path(), {path.string(), renderer, jobs, flights}, line, i,
                                asked.size());
      } catch (const Stopped& stopped) {
        throw Stopped(stopped.signal,
                      fmt::format("{} of {} lost flights are explained; the same command goes on",
                                  lost.size() - asked.size() + i, lost.size()));
      }
    }();
    write_whole_file(folder.explanation_file(row.id), to_json(explained));
    fmt::print("{}: {} {} {}\n", row.id, explained.told.conclusion.sentence,
               explained.told.conclusion.disagreement, warning_of_digest(explained.log.result, row.digest));
    std::fflush(stdout);
    collect(folder, campaign);  // so that flights.csv has the cause already
  }
  const std::vector<ExplainedRow> rows = explained_rows(folder, collect(folder, campaign).rows);
  fmt::print("{}\n{}\nunderstory report {} puts this on the campaign's page\n", to_text(causes_table(rows)),
             to_text(savings_table(rows)), path.string());
}

void add_explain_command(CommandLine& line) {
  const auto arguments = std::make_shared<ExplainArguments>();
  Command& command =
      line.add({"explain", "find out why a flight was lost: which part of the stack, made ideal, saves it",
                "understory explain runs/paper-1008"});
  command
      .text("folder", "FOLDER", arguments->folder,
            "folder of a run whose flight was lost, or of a campaign: its lost flights")
      .required();
  command.whole("--flights", arguments->flights, 130, 10'000,
                "fly at most so many flights, 130 or more: fewer do not try every part");
  command.whole(
      "--first-seed", arguments->first_seed, 1, 1'000'000,
      "for one run: first seed of the noise that is drawn anew; one that is 24 or more away gives a second "
      "opinion, which takes the place of the first");
  add_jobs_option(command, arguments->jobs, "flights");
  add_renderer_option(command, arguments->renderer);
  command.runs([arguments] { return run_explain(*arguments); });
}

}  // namespace understory
