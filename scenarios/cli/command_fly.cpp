#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>

#include "scenarios/cli/commands.hpp"
#include "scenarios/fly.hpp"
#include "scenarios/scenario_io.hpp"

namespace understory {
namespace {

struct FlyArguments : ScenarioArguments {
  std::string seed;
  std::string out;  // empty: runs/<name>-<seed>
  RendererKind renderer = RendererKind::osmesa;
  bool video = false;
  bool quiet = false;
};

void print_progress(const FlightProgress& progress) {
  const std::string clearance =
      std::isfinite(progress.min_clearance_m) ? fmt::format("{:.2f} m", progress.min_clearance_m) : "-";
  fmt::print("\r\033[K{:5.2f} s  {:5.1f} of {:.0f} m  {:4.1f} m/s  least clearance {}  {:.2f} x real time",
             progress.simulated_s, progress.progress_m, progress.goal_m, progress.speed_mps, clearance,
             progress.wall_s > 0 ? progress.simulated_s / progress.wall_s : 0.0);
  std::fflush(stdout);
}

/// Here, where it is still known which line named the rig.
void require_rig(const Scenario& scenario, const FlyArguments& arguments,
                 const std::filesystem::path& models_folder) {
  const std::filesystem::path rigs = models_folder / "rigs";
  std::error_code ignored;
  if (std::filesystem::exists(rigs / (scenario.rig + ".yaml"), ignored)) return;
  if (std::filesystem::is_regular_file(scenario.rig, ignored)) return;
  throw ScenarioError(fmt::format("{}: rig: expected a name in {} or a rig file, got '{}'",
                                  where_given(scenario_file(arguments.scenario), arguments.settings, "rig"),
                                  rigs.string(), scenario.rig));
}

int run_fly(const FlyArguments& arguments) {
  const Scenario scenario = load_scenario(scenario_file(arguments.scenario), arguments.settings);
  FlyOptions options;
  options.models_folder = project_root() / "models";
  require_rig(scenario, arguments, options.models_folder);
  options.output_folder =
      arguments.out.empty() ? fmt::format("runs/{}-{}", scenario.name, scenario.seed) : arguments.out;
  options.video = arguments.video;
  options.renderer = arguments.renderer;
  const bool shows_progress = !arguments.quiet && isatty(STDOUT_FILENO) == 1;
  if (shows_progress) options.on_progress = print_progress;
  const FlightResult result = fly(scenario, options);
  if (shows_progress) fmt::print("\r\033[K");
  if (!arguments.quiet) {
    fmt::print("{}", to_report(result));
    fmt::print("  {:<18}{}\n", "files", options.output_folder.string());
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
  command->add_flag("--video", arguments->video, "also make flight.mp4 and still.png");
  command->add_flag("--quiet", arguments->quiet, "print nothing");
  command->callback([arguments, &chosen] {
    // A seed is a setting like any other, only more often given.
    if (!arguments->seed.empty()) arguments->settings.push_back("seed=" + arguments->seed);
    chosen = [arguments] { return run_fly(*arguments); };
  });
}

}  // namespace understory
