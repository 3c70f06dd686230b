#include <fmt/format.h>

#include <memory>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/cli/flight_terminal.hpp"
#include "scenarios/output/output_folder.hpp"
#include "scenarios/recording/carried_path.hpp"
#include "scenarios/recording/euroc_recording.hpp"
#include "scenarios/recording/record.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

struct RecordArguments : ScenarioArguments {
  std::string out;
  RendererKind renderer = RendererKind::osmesa;
  std::optional<double> walk_mps;  // nothing: flies
  std::string path;                // empty: none to follow
  std::optional<double> height_m;
  bool quiet = false;
  bool force = false;
};

std::string report_of(const FlownRecording& flight) {
  return to_report(flight.result) + fmt::format("  {:<18}{}\n", "frames", flight.frames);
}

std::string report_of(const RecordedWalk& walk) {
  return fmt::format(
      "walked {:.1f} m in {:.1f} s, from x = {:.1f} m along y = {:.1f} m, {:.2f} m high: {} frames\n",
      walk.carried.carried_m, walk.carried.carried_s, walk.path.from_x_m, walk.path.lane_y_m,
      walk.path.config.height_m, walk.carried.frames);
}

std::string report_of(const Carried& carried) {
  return fmt::format("carried {:.1f} m in {:.1f} s: {} frames\n", carried.carried_m, carried.carried_s,
                     carried.frames);
}

/// As given, or in the source tree from any working directory: scenarios/paths/level.tum.
std::filesystem::path path_file(const std::filesystem::path& given) {
  std::error_code ignored;
  const std::filesystem::path in_root = data_root() / given;
  const bool only_there =
      !std::filesystem::exists(given, ignored) && std::filesystem::exists(in_root, ignored);
  return only_there ? in_root : given;
}

std::string record(const RecordArguments& arguments, const Scenario& scenario, FlyOptions options) {
  const std::vector<TimedPose> path =
      arguments.path.empty() ? std::vector<TimedPose>{} : read_path(path_file(arguments.path));
  ProgressLine line(!arguments.quiet);
  options.on_progress = [&](const FlightProgress& progress) { show(line, progress); };
  if (!path.empty()) return report_of(follow_recorded(scenario, path, options));
  if (!arguments.walk_mps) return report_of(fly_recorded(scenario, options));
  return report_of(walk_recorded(
      scenario, {*arguments.walk_mps, arguments.height_m.value_or(WalkConfig{}.height_m)}, options));
}

int run_record(const RecordArguments& arguments) {
  if (arguments.height_m && !arguments.walk_mps) throw ScenarioError("--height: expected beside --walk");
  if (!arguments.path.empty() && arguments.walk_mps) throw ScenarioError("--path: expected without --walk");
  const Scenario scenario =
      load_scenario(scenario_file(arguments.scenario), arguments.all_settings(), arguments.with_files());
  FlyOptions options;
  options.models_folder = data_root() / "models";
  require_rig(scenario, arguments, options.models_folder / "rigs");
  options.renderer = arguments.renderer;
  OutputFolder output(arguments.out, recording_contents(scenario),
                      arguments.force ? Replace::anything : Replace::nothing);
  options.output_folder = output.path();
  const std::string report = record(arguments, scenario, options);
  output.finish();
  if (!arguments.quiet) fmt::print("{}  {:<18}{}\n", report, "files", arguments.out);
  return exit_goal;
}

}  // namespace

void add_record_command(CommandLine& line) {
  const auto arguments = std::make_shared<RecordArguments>();
  Command& command = line.add(
      {"record",
       "fly, walk or be carried through a scenario and keep images, true depth and poses as a EuRoC data set",
       "understory record forest --out recordings/forest", "the recording is whole"});
  add_scenario_options(command, *arguments);
  command.text("--out", "FOLDER", arguments->out, "for the recording; gets mav0").required();
  add_renderer_option(command, arguments->renderer);
  command.flag("--force", arguments->force, "replace a recording that is in the folder already");
  command.flag("--quiet", arguments->quiet, "print nothing");
  command.flag_or_number("--walk", 1.4, arguments->walk_mps, 0.1, 5.0,
                         "--walk or --walk=SPEED: carry the cameras through at a walk (1.4 m/s)");
  command.text("--path", "FILE", arguments->path,
               "carry the cameras along these poses: TUM, EuRoC, or a run's trajectory.csv");
  command.number("--height", arguments->height_m, 0.3, 8.0,
                 fmt::format("of the walk, m (default: {})", WalkConfig{}.height_m));
  command.runs([arguments] { return run_record(*arguments); });
}

}  // namespace understory
