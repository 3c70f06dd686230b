#include <fmt/format.h>
#include <sys/resource.h>

#include <memory>
#include <optional>

#include "scenarios/campaign/flight_row.hpp"
#include "scenarios/campaign/gate.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/cli/flight_terminal.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/flight/run_record.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/output_folder.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

struct FlyArguments : ScenarioArguments {
  std::string out;  // empty: runs/<name>-<seed>, or with a row no run folder at all
  std::string row;  // empty: none, as the next
  std::string junit;
  RendererKind renderer = RendererKind::osmesa;
  bool video = false;
  bool quiet = false;
  bool force = false;
};

/// As a campaign reads it. The row file's name is the flight's id, the scenario's file that of its condition.
FlightRow row_of(const FlyArguments& arguments, const Scenario& scenario, const FlightResult& result) {
  FlightRow row = flown_row(result);
  row.cruise_speed_mps = scenario.autopilot.autopilot.flight_model.cruise_speed_mps;
  row.square_metres_per_tree = scenario.forest.square_metres_per_tree;
  row.goal_m = scenario.goal_x_m();
  row.condition = fs::path(arguments.scenario).stem().string();
  row.id = arguments.row.empty() ? fmt::format("{}-{}", row.condition, row.seed)
                                 : fs::path(arguments.row).stem().string();
  return row;
}

FlightCost cost_of(const FlightResult& result) {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return {result.wall_s, static_cast<double>(usage.ru_maxrss) * 1.024e-3};
}

fs::path folder_of(const FlyArguments& arguments, const Scenario& scenario) {
  if (!arguments.out.empty()) return arguments.out;
  if (!arguments.row.empty()) return {};
  return fmt::format("runs/{}-{}", scenario.name, scenario.seed);
}

/// What is to be written beside the run folder; within it, it can be once that is there.
void require_writable_beside(const fs::path& folder, const std::string& file) {
  if (file.empty()) return;
  std::error_code ignored;
  const fs::path above = fs::weakly_canonical(fs::absolute(file), ignored).parent_path();
  if (folder.empty() || above != fs::weakly_canonical(fs::absolute(folder), ignored)) require_writable(file);
}

FlightResult flown(const Scenario& scenario, const FlyOptions& options, std::optional<OutputFolder>& output) {
  try {
    FlightResult result = fly(scenario, options);
    if (output) output->finish();
    return result;
  } catch (const LostFilm&) {
    output->finish();
    throw;
  }
}

int run_fly(const FlyArguments& arguments) {
  const Scenario scenario =
      load_scenario(scenario_file(arguments.scenario), arguments.all_settings(), arguments.with_files());
  FlyOptions options;
  options.models_folder = data_root() / "models";
  require_rig(scenario, arguments, options.models_folder / "rigs");
  options.video = arguments.video;
  options.renderer = arguments.renderer;
  const fs::path folder = folder_of(arguments, scenario);
  if (options.video && folder.empty()) throw ScenarioError("--video: expected --out beside --row");
  for (const std::string& file : {arguments.row, arguments.junit}) require_writable_beside(folder, file);
  std::optional<OutputFolder> output;
  if (!folder.empty()) {
    output.emplace(folder, run_contents(scenario), arguments.force ? Replace::anything : Replace::same);
    options.output_folder = output->path();
  }
  ProgressLine line(!arguments.quiet);
  options.on_progress = [&](const FlightProgress& progress) { show(line, progress); };
  const FlightResult result = flown(scenario, options, output);
  line.clear();
  const FlightRow row = row_of(arguments, scenario, result);
  if (!arguments.row.empty()) write_lasting_file(arguments.row, to_json(FlightFile{row, cost_of(result)}));
  if (!arguments.junit.empty()) write_whole_file(arguments.junit, campaign_junit({row}));
  if (!arguments.quiet) {
    fmt::print("{}", to_report(result));
    if (output) fmt::print("  {:<18}{}\n", "files", folder.string());
    if (options.video) fmt::print("  {:<18}{}\n", "video", (folder / "flight.mp4").string());
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
  command.flag("--force", arguments->force, "replace a run of another configuration in the run folder");
  command.flag("--quiet", arguments->quiet, "print nothing");
  command.runs([arguments] { return run_fly(*arguments); });
}

}  // namespace understory
