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

Scenario scenario_of_run(const fs::path& run) {
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
void write_page(const ExplainedFlight& explained, const std::string& json, const fs::path& run,
                const std::string& warning, FolderMark& mark) {
  std::error_code ignored;
  if (fs::exists(run / "flight.mp4", ignored) && fs::exists(run / "report.html", ignored)) {
    fmt::print("understory report {} puts this on the page, beside the film\n", run.string());
    return;
  }
  mark.require_own("report.html");
  FlightPageExtras extras{data_root()};
  extras.warning = warning;
  extras.chapter = explanation_chapter(explanation_from_json(json, "explain.json"));
  write_whole_file(run / "report.html", flight_page(explained.log, extras), &mark);
  fmt::print("page: {}\n", (run / "report.html").string());
}

ExplainOptions options_of(const fs::path& work, RendererKind renderer, int jobs, int flights,
                          int first_seed = 1) {
  return {.models_folder = data_root() / "models",
          .work_folder = work,
          .renderer = renderer,
          .jobs = jobs,
          .first_seed = first_seed,
          .flights = flights};
}

/// What is found of one flight, as explain.json.
struct Explained {
  ExplainedFlight flight;
  Conclusion conclusion;
  std::string json;
};

/// `flown_before` and `flown_after` are the flights of the lost flights explained before and after it.
Explained explained_flight(const Scenario& scenario, ExplainOptions options, ProgressLine& line,
                           const std::string& title = "", std::size_t flown_before = 0,
                           std::size_t flown_after = 0) {
  const auto most = static_cast<std::size_t>(options.flights);
  options.on_progress = [&](std::size_t flown) {
    line.show(fmt::format("{}{} of at most {} flights", title, flown, most), flown_before + flown,
              flown_after + most - std::min(flown, most));
  };
  Explained explained{explain_flight(scenario, options), {}, ""};
  const std::vector<Evidence> evidence =
      evidence_in(explained.flight.log, explained.flight.explanation.decisive_s.back());
  explained.conclusion = conclusion_of(explained.flight.explanation, evidence);
  explained.json = to_json(explained.flight, evidence, explained.conclusion);
  return explained;
}

int explain_run(const ExplainArguments& arguments) {
  const fs::path run = arguments.folder;
  const Scenario scenario = scenario_of_run(run);
  const RunResult result = result_of_run(run);
  if (result.reached_goal)
    throw ScenarioError(
        fmt::format("{}: this flight reached its goal; only a lost flight is explained", run.string()));
  FolderMark mark(run, flight_results, run);
  mark.require_own("explain.json");
  const Unfinished work(run / ".explain");
  ProgressLine line;
  const Explained explained =
      explained_flight(scenario,
                       options_of(work.path(), arguments.renderer, jobs_or_cores(arguments.jobs),
                                  arguments.flights, arguments.first_seed),
                       line);
  write_whole_file(run / "explain.json", explained.json, &mark);
  const Explanation& why = explained.flight.explanation;
  fmt::print("{}\n{}\n{}\n{}", explained.conclusion.sentence, to_text(effects_table(why)),
             to_text(chances_table(why)),
             explained.conclusion.disagreement.empty() ? "" : explained.conclusion.disagreement + "\n");
  const std::string warning = warning_of_digest(explained.flight.log.result, result.digest);
  if (!warning.empty()) fmt::print("{}\n", warning);
  write_page(explained.flight, explained.json, run, warning, mark);
  return exit_goal;
}

int run_explain(const ExplainArguments& arguments) {
  if (!holds_campaign(arguments.folder)) return explain_run(arguments);
  if (arguments.first_seed != 1)
    throw ScenarioError(
        "--first-seed: is for the folder of a run; fly a campaign's flight again to explain it twice");
  explain_campaign(arguments.folder, arguments.renderer, jobs_or_cores(arguments.jobs), arguments.flights);
  return exit_goal;
}

}  // namespace

void explain_campaign(const fs::path& path, RendererKind renderer, int jobs, int flights) {
  const CampaignFolder folder{path};
  const Campaign campaign = read_campaign(folder);
  std::vector<FlightRow> lost = gather(folder, campaign).rows;
  if (std::ranges::none_of(lost, &FlightRow::flown))
    throw ScenarioError(fmt::format("{}: none of its flights is flown yet", path.string()));
  std::erase_if(lost, [](const FlightRow& row) { return !row.flown() || row.reached_goal(); });
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
    const auto most = static_cast<std::size_t>(flights);
    const Explained explained = [&] {
      try {
        return explained_flight(scenario, options_of(work.path(), renderer, jobs, flights), line,
                                fmt::format("lost flight {} of {}: ", i + 1, asked.size()), i * most,
                                (asked.size() - i - 1) * most);
      } catch (const Stopped& stopped) {
        throw Stopped(stopped.signal,
                      fmt::format("{} of {} lost flights are explained; the same command goes on",
                                  lost.size() - asked.size() + i, lost.size()));
      }
    }();
    write_whole_file(folder.explanation_file(row.id), explained.json);
    fmt::print("{}: {} {}\n", row.id, explained.conclusion.sentence, explained.conclusion.disagreement);
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
      "for one run: first seed of the noise that is drawn anew; another one gives a second opinion, which "
      "takes the place of the first");
  add_jobs_option(command, arguments->jobs, "flights");
  add_renderer_option(command, arguments->renderer);
  command.runs([arguments] { return run_explain(*arguments); });
}

}  // namespace understory
