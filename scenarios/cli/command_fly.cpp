#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <memory>

#include "scenarios/campaign/flight_row.hpp"
#include "scenarios/campaign/junit.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/cli/flight_terminal.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

struct FlyArguments : ScenarioArguments {
  std::string out;  // empty: runs/<name>-<seed>, or with a row no run folder at all
  std::string row;  // empty: none, as the next
  std::string junit;
  RendererKind renderer = RendererKind::osmesa;
  bool video = false;
  bool quiet = false;
};

/// As a campaign reads it. The row file's name is the flight's id, the scenario's file that of its condition.
FlightRow row_of(const FlyArguments& arguments, const Scenario& scenario, const FlightResult& result) {
  FlightRow row = flown_row(result);
  row.cruise_speed_mps = scenario.autopilot.autopilot.flight_model.cruise_speed_mps;
  row.square_metres_per_tree = scenario.forest.square_metres_per_tree;
  row.goal_m = scenario.goal_x_m();
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
      load_scenario(scenario_file(arguments.scenario), arguments.all_settings(), arguments.with_files());
  FlyOptions options;
  options.models_folder = data_root() / "models";
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

void add_fly_command(CommandLine& line) {
  const auto arguments = std::make_shared<FlyArguments>();
  Command& command = line.add({"fly", "fly a scenario once", "understory fly forest --seed 7 --video",
                               "the goal was reached", "it was not"});
  add_scenario_options(command, *arguments);
  command.text("--out", "FOLDER", arguments->out, "run folder (default: runs/NAME-SEED)");
  add_renderer_option(command, arguments->renderer);
  command.text("--row", "FILE", arguments->row,
               "write the flight's row there, as campaign and collect read it; no run folder");
  command.text("--junit", "FILE", arguments->junit, "write the flight as a JUnit test case");
  command.flag("--video", arguments->video, "also make flight.mp4 and still.png");
  command.flag("--quiet", arguments->quiet, "print nothing");
  command.runs([arguments] { return run_fly(*arguments); });
}

}  // namespace understory
