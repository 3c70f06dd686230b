#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "scenarios/campaign/campaign_page.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/output_folder.hpp"
#include "scenarios/output/progress_line.hpp"
#include "scenarios/recording/flight_mcap.hpp"
#include "scenarios/scenario/scenario_io.hpp"

/// What a run's folder does not hold comes from flying it again.
namespace understory {
namespace {

namespace fs = std::filesystem;

struct AgainArguments {
  std::string folder;
  std::string out;
  RendererKind renderer = RendererKind::osmesa;
  bool quiet = false;
};

struct ReportArguments : AgainArguments {
  std::string baseline;
  bool no_film = false;
};

struct McapArguments : AgainArguments {
  bool compress = false;
};

/// What the run's result.json says; empty where the run never came to its end.
std::string digest_of(const fs::path& run) {
  const fs::path file = run / "result.json";
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return "";
  const auto json = parse_json(read_file(file, maximum_json_bytes));
  if (!json.is_object() || !json.contains("digest") || !json["digest"].is_string())
    throw ScenarioError(fmt::format("{}: expected a flight's result with a digest", file.string()));
  return json["digest"];
}

Scenario scenario_of_run(const fs::path& run) {
  std::error_code ignored;
  if (!fs::exists(run / "scenario.yaml", ignored))
    throw ScenarioError(fmt::format(
        "{}: expected the folder of a run, which holds scenario.yaml, or of a campaign", run.string()));
  return load_scenario(run / "scenario.yaml");
}

/// Flies the run again and says how `out` came about; the exit status.
int fly_again(const Scenario& scenario, const AgainArguments& arguments, FlyOptions options, const fs::path& out,
              const std::function<void()>& place_output) {
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

int run_report(const ReportArguments& arguments) {
  const fs::path run = arguments.folder;
  const fs::path out = arguments.out.empty() ? run / "report.html" : fs::path(arguments.out);
  const Scenario scenario = scenario_of_run(run);
  FlyOptions options;
  options.expected_digest = digest_of(run);
  options.report = true;
  options.video = !arguments.no_film;
  require_writable(out);
  const fs::path folder = fs::absolute(out).parent_path();
  const FolderLock lock(folder, folder);
  Unfinished flown(folder / (out.filename().string() + ".part"));
  prepare_output_folder(flown.path());
  options.output_folder = flown.path();
  return fly_again(scenario, arguments, options, out,
                   [&] { Unfinished(flown.path() / "report.html").become(out); });
}

/// Only reads what the flights left. The exit status is the gate's where there is one.
int report_campaign(const ReportArguments& arguments) {
  const CampaignFolder folder{arguments.folder};
  const fs::path out = arguments.out.empty() ? folder.path / "report.html" : fs::path(arguments.out);
  const Campaign campaign = read_campaign(folder);
  const Collected collected = gather(folder, campaign);
  std::optional<GatedCampaign> gated;
  if (!arguments.baseline.empty()) {
    const fs::path baseline = arguments.baseline;
    const Comparison comparison = compare_campaigns(read_campaign_rows(baseline), collected.rows);
    gated = GatedCampaign{baseline.filename().string(), comparison, judge(comparison)};
  }
  require_writable(out);
  write_whole_file(out, campaign_page(folder, campaign, collected, data_root(), gated));
  if (!arguments.quiet) fmt::print("{}\n", out.string());
  return gated && !gated->verdict.passes() ? exit_not_goal : exit_goal;
}

int run_report_of_either(const ReportArguments& arguments) {
  std::error_code ignored;
  if (fs::exists(fs::path(arguments.folder) / "campaign.json", ignored)) return report_campaign(arguments);
  if (!arguments.baseline.empty()) throw ScenarioError("--baseline: expected a campaign's folder before it");
  return run_report(arguments);
}

int run_mcap(const McapArguments& arguments) {
  const fs::path run = arguments.folder;
  const fs::path out = arguments.out.empty() ? run / "flight.mcap" : fs::path(arguments.out);
  const Scenario scenario = scenario_of_run(run);
  FlyOptions options;
  options.expected_digest = digest_of(run);
  require_writable(out);
  FlightMcap log(out, arguments.compress);
  options.observers.push_back(&log);
  return fly_again(scenario, arguments, options, out, [] {});
}

void add_again_options(Command& command, AgainArguments& arguments, const std::string& out) {
  command.text("folder", "FOLDER", arguments.folder, "a run's folder").required();
  command.text("--out", "FILE", arguments.out, out);
  add_renderer_option(command, arguments.renderer);
  command.flag("--quiet", arguments.quiet, "print nothing");
}

}  // namespace

void add_report_command(CommandLine& line) {
  const auto arguments = std::make_shared<ReportArguments>();
  Command& command =
      line.add({"report", "make a page to look at, of a flight or of a campaign",
                "understory report runs/forest-7", "the page is there",
                "it is there, but shows another flight than the run's, or the gate fails"});
  add_again_options(command, *arguments, "the page (default: FOLDER/report.html)");
  command.text("--baseline", "FOLDER", arguments->baseline, "of a campaign: the one it is gated against");
  command.flag("--no-film", arguments->no_film, "leave the film out: a smaller page, made sooner");
  command.runs([arguments] { return run_report_of_either(*arguments); });
}

void add_mcap_command(CommandLine& line) {
  const auto arguments = std::make_shared<McapArguments>();
  Command& command = line.add({"mcap", "make a log of a flight for Foxglove and Rerun",
                               "understory mcap runs/forest-7", "the log is there",
                               "it is there, but of another flight than the run's"});
  add_again_options(command, *arguments, "the log (default: FOLDER/flight.mcap)");
  command.flag("--zstd", arguments->compress, "compress it");
  command.runs([arguments] { return run_mcap(*arguments); });
}

}  // namespace understory
