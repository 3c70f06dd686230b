#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "scenarios/campaign/campaign_page.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/explain/explain_campaign.hpp"
#include "scenarios/explain/explain_report.hpp"
#include "scenarios/flight/flight_logger.hpp"
#include "scenarios/flight/flight_page.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/output_folder.hpp"
#include "scenarios/output/progress_line.hpp"
#include "scenarios/recording/flight_mcap.hpp"
#include "scenarios/scenario/scenario_io.hpp"

/// Pages and logs are made of the log that a run has kept. Films and images come from flying it again.
namespace understory {
namespace {

namespace fs = std::filesystem;

/// Of a flight.log; one of a flight of 600 s has 12 MB.
constexpr std::size_t maximum_log_bytes = std::size_t{256} << 20;

struct AgainArguments {
  std::string folder;
  std::string out;
  RendererKind renderer = RendererKind::osmesa;
  bool quiet = false;
};

struct ReportArguments : AgainArguments {
  std::string baseline;
  GateRule rule;
  std::vector<std::string> tolerances;
  bool no_video = false;
};

struct McapArguments : AgainArguments {
  bool exact_images = false;
  bool no_images = false;
};

Scenario scenario_of_run(const fs::path& run) {
  std::error_code ignored;
  if (!fs::exists(run / "scenario.yaml", ignored))
    throw ScenarioError(
        fmt::format("{}: neither the folder of a run (with scenario.yaml) nor of a campaign", run.string()));
  if (fs::exists(run / "mav0", ignored) && !fs::exists(run / "result.json", ignored))
    throw ScenarioError(
        fmt::format("{}: recorded along a path: nothing flew, so there is no report", run.string()));
  return load_scenario(run / "scenario.yaml");
}

FlightLog log_of_run(const fs::path& run) {
  const fs::path file = run / "flight.log";
  std::error_code ignored;
  if (!fs::exists(file, ignored))
    throw ScenarioError(fmt::format(
        "{}: flight.log is missing: this run was written by an older version; fly it again", run.string()));
  return flight_log_from_bytes(read_file(file, maximum_log_bytes), file.string(), data_root() / "models");
}

/// Why the run was lost, where explain has found it out.
std::vector<SheetSection> chapter_of(const fs::path& run) {
  const fs::path file = run / "explain.json";
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  return explanation_chapter(explanation_from_json(read_file(file, maximum_json_bytes), file.string()));
}

int told(const fs::path& file, const std::string& warning, bool quiet) {
  if (!quiet)
    fmt::print("{}: {}\n", file.string(),
               warning.empty() ? "made of the run's log"
                               : "made of a log with another digest than the run's result");
  return warning.empty() ? exit_goal : exit_not_goal;
}

/// Where the result goes: the option's file, or one of that name in the folder, then under its mark.
struct AgainOutput {
  fs::path file;
  std::optional<FolderMark> mark;

  AgainOutput(const AgainArguments& arguments, const ResultKind& kind, const char* name,
              const std::string& baseline = "") {
    const fs::path folder = arguments.folder;
    file = arguments.out.empty() ? folder / name : fs::path(arguments.out);
    require_outside(file, folder, name);
    if (!baseline.empty()) require_outside(file, baseline, name);
    if (path_within(file, folder) == name) {
      // A run must not be replaced while it is flown again: the result would pass for the new one's. A
      // campaign goes on.
      mark.emplace(folder, kind, folder,
                   kind.grows ? FolderMark::Manner::beside_others : FolderMark::Manner::alone);
      mark->require_own(name);
    }
    require_writable(file);
  }
  FolderMark* listed_in() { return mark ? &*mark : nullptr; }
};

/// Flies the run again and says how `out` came about; the exit status.
int fly_again(const Scenario& scenario, const AgainArguments& arguments, FlyOptions options,
              const fs::path& out, const std::function<void()>& place_output) {
  options.models_folder = data_root() / "models";
  options.renderer = arguments.renderer;
  ProgressLine line(!arguments.quiet);
  options.on_progress = [&](const FlightProgress& progress) {
    line.show(fmt::format("flying it again: {:5.2f} s  {:5.1f} of {:.0f} m", progress.simulated_s,
                          progress.progress_m, progress.goal_m));
  };
  const FlightResult result = fly(scenario, options);
  line.clear();
  place_output();
  const std::string& expected = options.expected_digest;
  const bool is_same = expected.empty() || expected == result.digest;
  if (!arguments.quiet)
    fmt::print("{}: {}\n", out.string(),
               expected.empty() ? "flown from scenario.yaml; the run holds no result to compare with"
               : is_same        ? "flown again, with the run's digest"
                                : "flown again with another digest than the run's");
  return is_same ? exit_goal : exit_not_goal;
}

/// The page without a film.
int report_from_log(const ReportArguments& arguments) {
  const fs::path run = arguments.folder;
  scenario_of_run(run);  // or this is no run
  AgainOutput output(arguments, flight_results, "report.html");
  const FlightLog log = log_of_run(run);
  FlightPageExtras extras{data_root()};
  extras.warning = warning_of_digest(log.result, result_of_run(run).digest);
  extras.chapter = chapter_of(run);
  write_whole_file(output.file, flight_page(log, extras), output.listed_in());
  return told(output.file, extras.warning, arguments.quiet);
}

int run_report(const ReportArguments& arguments) {
  if (arguments.no_video) return report_from_log(arguments);
  const fs::path run = arguments.folder;
  const Scenario scenario = scenario_of_run(run);
  FlyOptions options;
  options.expected_digest = result_of_run(run).digest;
  options.report = true;
  options.video = true;
  options.chapter = chapter_of(run);
  AgainOutput output(arguments, flight_results, "report.html");
  // The film, too, is made as a file first: beside the page, or where that is a device.
  const fs::path beside = is_stream(output.file)
                              ? fs::temp_directory_path() / fmt::format("report-{}", getpid())
                              : fs::weakly_canonical(fs::absolute(output.file));
  const UnfinishedFolder flown(beside, flight_results, output.file);
  options.output_folder = flown.path();
  return fly_again(scenario, arguments, options, output.file, [&] {
    write_whole_file(output.file, read_file(flown.path() / "report.html", maximum_image_bytes),
                     output.listed_in());
  });
}

/// Only reads what the flights left. The exit status is the gate's where there is one.
int report_campaign(const ReportArguments& arguments) {
  const CampaignFolder folder{arguments.folder};
  const Campaign campaign = read_campaign(folder);
  AgainOutput output(arguments, campaign_results, "report.html", arguments.baseline);
  const Collected collected = gather(folder, campaign);
  std::optional<GatedCampaign> gated;
  if (!arguments.baseline.empty()) {
    const GateRule rule = rule_of(arguments.rule, arguments.tolerances);
    const ComparedCampaign baseline = read_compared(arguments.baseline);
    gated = GatedCampaign{
        {arguments.baseline, arguments.folder},
        compare_campaigns(baseline.rows, collected.rows, drawn_differently(baseline.campaign, campaign)),
        {},
        ""};
    gated->verdict = verdict_on(gated->comparison, rule);
    gated->sentence = sentence_of(gated->comparison, gated->verdict, rule);
  }
  write_whole_file(output.file,
                   campaign_page(folder, campaign, collected, data_root(), gated,
                                 causes_chapter(explained_rows(folder, collected.rows))),
                   output.listed_in());
  if (!arguments.quiet) fmt::print("{}\n", output.file.string());
  return gated ? status_of(gated->verdict) : exit_goal;
}

int run_report_of_either(const ReportArguments& arguments) {
  if (holds_campaign(arguments.folder)) return report_campaign(arguments);
  if (!arguments.baseline.empty())
    throw ScenarioError("--baseline requires the folder of a campaign before it");
  return run_report(arguments);
}

int run_mcap(const McapArguments& arguments) {
  const fs::path run = arguments.folder;
  const Scenario scenario = scenario_of_run(run);
  if (arguments.no_images) {
    AgainOutput output(arguments, flight_results, "flight.mcap");
    const FlightLog log = log_of_run(run);
    FlightMcap(log, output.file, arguments.exact_images, output.listed_in()).write_whole_log();
    return told(output.file, warning_of_digest(log.result, result_of_run(run).digest), arguments.quiet);
  }
  FlyOptions options;
  options.expected_digest = result_of_run(run).digest;
  AgainOutput output(arguments, flight_results, "flight.mcap");
  FlightLogger logger;
  FlightMcap mcap(logger.log(), output.file, arguments.exact_images, output.listed_in());
  options.logger = &logger;
  options.observers.push_back(&mcap);
  return fly_again(scenario, arguments, options, output.file, [] {});
}

void add_again_options(Command& command, AgainArguments& arguments, const char* folder, const char* out) {
  command.text("folder", "FOLDER", arguments.folder, folder).required();
  command.text("--out", "FILE", arguments.out, out);
  add_renderer_option(command, arguments.renderer);
  command.flag("--quiet", arguments.quiet, "print nothing");
}

}  // namespace

RunResult result_of_run(const fs::path& run) {
  const fs::path file = run / "result.json";
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  const auto json = parse_json(read_file(file, maximum_json_bytes));
  if (!json.is_object() || !json.contains("digest") || !json["digest"].is_string())
    throw ScenarioError(fmt::format("{}: not a flight's result with a digest", file.string()));
  return {json["digest"], json.contains("outcome") && json["outcome"] == word_for(Outcome::goal)};
}

void add_report_command(CommandLine& line) {
  const auto arguments = std::make_shared<ReportArguments>();
  Command& command =
      line.add({"report", "write an HTML page about a flight (video, replay, charts) or about a campaign",
                "understory report runs/forest-7", "the page was written",
                "the page was written, but the repeated flight differs from the run (another digest), or the "
                "gate says worse",
                "the page was written; the gate has not enough flights"});
  add_again_options(command, *arguments, "folder of a run or of a campaign",
                    "file name of the page (default: FOLDER/report.html)");
  command.text("--baseline", "FOLDER", arguments->baseline,
               "for a campaign: results folder of the campaign before the change; adds the comparison and "
               "verdict of gate");
  add_rule_options(command, arguments->rule, arguments->tolerances);
  command.flag("--no-video", arguments->no_video,
               "make the page without video from the run's flight.log; this takes no new flight");
  command.runs([arguments] { return run_report_of_either(*arguments); });
}

void add_mcap_command(CommandLine& line) {
  const auto arguments = std::make_shared<McapArguments>();
  Command& command =
      line.add({"mcap", "write a flight as an MCAP file for Foxglove and Rerun",
                "understory mcap runs/forest-7", "the MCAP file was written",
                "the MCAP file was written, but the repeated flight differs from the run (another digest)"});
  add_again_options(command, *arguments, "folder of a run",
                    "name of the MCAP file (default: FOLDER/flight.mcap)");
  const Command::Added exact =
      command.flag("--exact-images", arguments->exact_images,
                   "store every image as the autopilot had it (PNG); otherwise JPEG, 60 pairs a second");
  command
      .flag("--no-images", arguments->no_images,
            "make the MCAP file without images from the run's flight.log; this takes no new flight")
      .excludes(exact);
  command.runs([arguments] { return run_mcap(*arguments); });
}

}  // namespace understory
