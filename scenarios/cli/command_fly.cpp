#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "scenarios/campaign/flight_row_io.hpp"
#include "scenarios/campaign/flown_row.hpp"
#include "scenarios/campaign/junit.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/cli/flight_terminal.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

struct FlyArguments : ScenarioArguments {
  std::string seed;
  std::string out;  // empty: runs/<name>-<seed>, or with a row no run folder at all
  std::string row;  // empty: none, as the next
  std::string junit;
  RendererKind renderer = RendererKind::osmesa;
  bool video = false;
  bool quiet = false;
};

/// As a campaign reads it. The row file's name is the flight's id, the scenario's file that of its condition.
FlightRow row_of(const FlyArguments& arguments, const Scenario& scenario, const FlightResult& result) {
  FlightRow row = flown_row(scenario, result);
  row.condition = std::filesystem::path(arguments.scenario).stem().string();
  row.id = arguments.row.empty() ? fmt::format("{}-{}", row.condition, row.seed)
                                 : std::filesystem::path(arguments.row).stem().string();
  return row;
}

FlightCost cost_of(const FlightResult& result) {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return {result.wall_s, static_cast<double>(usage.ru_maxrss) * 1.024e-3};
}

int run_fly(const FlyArguments& arguments) {
  const Scenario scenario =
      load_scenario(scenario_file(arguments.scenario), arguments.settings, arguments.with);
  FlyOptions options;
  options.models_folder = project_root() / "models";
  require_rig(scenario, arguments, options.models_folder / "rigs");
  options.video = arguments.video;
  options.renderer = arguments.renderer;
  options.output_folder = arguments.out;
  if (arguments.out.empty() && arguments.row.empty())
    options.output_folder = fmt::format("runs/{}-{}", scenario.name, scenario.seed);
  if (options.video && options.output_folder.empty())
    throw ScenarioError("--video: expected --out beside --row");
  const bool shows_progress = !arguments.quiet && isatty(STDOUT_FILENO) == 1;
  if (shows_progress) options.on_progress = print_flight_progress;
  const FlightResult result = fly(scenario, options);
  if (shows_progress) fmt::print("\r\033[K");
  const FlightRow row = row_of(arguments, scenario, result);
  if (!arguments.row.empty()) write_lasting_file(arguments.row, to_json(FlightFile{row, cost_of(result)}));
  if (!arguments.junit.empty()) write_whole_file(arguments.junit, campaign_junit({row}));
  if (!arguments.quiet) {
    fmt::print("{}", to_report(result));
    if (!options.output_folder.empty()) fmt::print("  {:<18}{}\n", "files", options.output_folder.string());
    if (options.video) fmt::print("  {:<18}{}\n", "video", (options.output_folder / "flight.mp4").string());
  }
  return result.ending == Ending::goal ? exit_goal : exit_not_goal;
}

}  // namespace

void add_fly_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<FlyArguments>();
  CLI::App* command = app.add_subcommand("fly", "fly a scenario once");
  add_scenario_options(*command, *arguments);
  command->add_option("--seed", arguments->seed, "of course and sensors; goes before the scenario's own");
  command->add_option("--out", arguments->out, "run folder (default: runs/<name>-<seed>)");
  add_renderer_option(*command, arguments->renderer);
  command->add_option("--row", arguments->row,
                      "write the flight's row here, as campaign and collect read it; no run folder");
  command->add_option("--junit", arguments->junit, "write the flight as a JUnit test case");
  command->add_flag("--video", arguments->video, "also make flight.mp4 and still.png");
  command->add_flag("--quiet", arguments->quiet, "print nothing");
  command->callback([arguments, &chosen] {
    // A seed is a setting like any other, only more often given.
    if (!arguments->seed.empty()) arguments->settings.push_back("seed=" + arguments->seed);
    chosen = [arguments] { return run_fly(*arguments); };
  });
}

}  // namespace understory
