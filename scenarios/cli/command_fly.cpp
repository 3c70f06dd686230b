#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "planning/flight_model.hpp"
#include "scenarios/campaign/flight_row.hpp"
#include "scenarios/campaign/gate.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/flight/flight_logger.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/output_folder.hpp"
#include "scenarios/output/progress_line.hpp"
#include "scenarios/recording/carried_path.hpp"
#include "scenarios/recording/flight_mcap.hpp"
#include "scenarios/recording/record.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"
#include "sim/render/offscreen_context.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

struct FlightArguments {
  std::string scenario;               // a path, or a name in scenarios/library
  std::vector<std::string> with;      // files of keys, over the scenario's own
  std::vector<std::string> settings;  // key=value, over both
  std::string seed;                   // over all; empty: theirs
  std::string out;                    // of fly, empty: runs/<name>-<seed>, or with a row no run folder at all
  RendererKind renderer = RendererKind::osmesa;
  RecordingChoice recording;
  bool mcap = false;
  bool quiet = false;
  bool force = false;
};

void show(ProgressLine& line, const FlightProgress& progress) {
  const std::string clearance = std::isfinite(progress.minimum_clearance_m)
                                    ? fmt::format("{:.2f} m", progress.minimum_clearance_m)
                                    : "-";
  line.show(
      fmt::format("{:5.2f} s  {:5.1f} of {:.0f} m  {:4.1f} m/s  minimum clearance {}  {:.2f} x real time",
                  progress.simulated_s, progress.progress_m, progress.goal_m, progress.speed_mps, clearance,
                  progress.wall_s > 0 ? progress.simulated_s / progress.wall_s : 0.0));
}

/// Throws ScenarioError where the scenario's rig is neither a name in models/rigs nor a file: here, where it
/// is still known which line named it.
Scenario scenario_of(const FlightArguments& arguments) {
  const fs::path file = scenario_file(arguments.scenario), rigs = data_root() / "models" / "rigs";
  const std::vector<fs::path> with(arguments.with.begin(), arguments.with.end());
  std::vector<std::string> settings = arguments.settings;
  if (!arguments.seed.empty()) settings.push_back("seed=" + arguments.seed);
  Scenario scenario = load_scenario(file, settings, with);
  std::error_code ignored;
  if (!fs::exists(rigs / (scenario.rig + ".yaml"), ignored) && !fs::is_regular_file(scenario.rig, ignored))
    throw ScenarioError(fmt::format("{}: rig: must be a name in {} or a rig file, got '{}'",
                                    where_given(file, settings, "rig", with), rigs.string(), scenario.rig));
  return scenario;
}

/// What is odd about a scenario and no error, on standard error: a grid sweeps through it.
void warn_of(const Scenario& scenario, bool quiet) {
  const FlightModel model(scenario.airframe, scenario.autopilot.flight_model);
  const double asked_mps = model.config().cruise_speed_mps, fastest_mps = model.fastest_level_mps();
  if (!quiet && asked_mps > fastest_mps + 0.1)
    fmt::print(stderr,
               "understory: warning: autopilot.flight_model.cruise_speed_mps: the aircraft holds at most "
               "{:.1f} m/s in level flight, {:g} m/s are asked for\n",
               fastest_mps, asked_mps);
}

FlyOptions options_of(const FlightArguments& arguments) {
  FlyOptions options;
  options.models_folder = data_root() / "models";
  options.renderer = arguments.renderer;
  return options;
}

/// The options that fly and record share; `out` and `force` say what those mean. Gives --out.
Command::Added add_flight_options(Command& command, FlightArguments& arguments, const std::string& out,
                                  const std::string& force) {
  command.text("scenario", "SCENARIO", arguments.scenario, "scenario file, or a name in scenarios/library")
      .required();
  command.text("--seed", "N", arguments.seed,
               "random seed for the obstacle course and the sensor noise; overrides the scenario's seed");
  add_with_option(command, arguments.with);
  add_settings_option(command, arguments.settings);
  const Command::Added folder = command.text("--out", "FOLDER", arguments.out, out);
  add_renderer_option(command, arguments.renderer);
  command.flag("--mcap", arguments.mcap, "also write flight.mcap, a log for Foxglove and Rerun");
  command.flag("--force", arguments.force, "replace " + force);
  command.flag("--quiet", arguments.quiet, "print nothing");
  return folder;
}

struct FlyArguments : FlightArguments {
  std::string row;  // empty: none, as the next
  std::string track;
  std::string junit;
  bool video = false;
  bool report = false;
};

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

/// What the options name is none of what the command reads, and none of the run's own files.
void require_separate_outputs(const FlyArguments& arguments, const fs::path& folder,
                              const Scenario& scenario) {
  std::vector<fs::path> others{scenario_file(arguments.scenario)};
  others.insert(others.end(), arguments.with.begin(), arguments.with.end());
  for (const fs::path& file : rig_files_of(scenario, data_root() / "models")) others.push_back(file);
  const std::vector<fs::path> outputs{arguments.row, arguments.track, arguments.junit};
  require_separate(outputs, others);
  for (const fs::path& output : outputs) {
    require_outside(output, folder);
    const fs::path within = path_within(output, folder);
    if (within.empty()) require_writable(output);
    if (within.has_parent_path()) refuse_other_use(output, "the run has no such folder");
  }
}

/// The file that --mcap asks for, as one of the flight's observers.
std::unique_ptr<FlightMcap> mcap_of(const FlightArguments& arguments, FlightLogger& logger,
                                    FlyOptions& options) {
  if (!arguments.mcap) return nullptr;
  auto mcap = std::make_unique<FlightMcap>(logger.log(), options.output_folder / "flight.mcap", false);
  options.logger = &logger;
  options.observers.push_back(mcap.get());
  return mcap;
}

int run_fly(const FlyArguments& arguments) {
  const Scenario scenario = scenario_of(arguments);
  FlyOptions options = options_of(arguments);
  options.report = arguments.report;
  options.video = arguments.video || arguments.report;
  const fs::path folder = folder_of(arguments, scenario);
  if (folder.empty() && (options.video || arguments.mcap || arguments.recording.form))
    throw ScenarioError(fmt::format("--{} requires --out where --row is given", options.report   ? "report"
                                                                                : options.video  ? "video"
                                                                                : arguments.mcap ? "mcap"
                                                                                                 : "record"));
  require_separate_outputs(arguments, folder, scenario);
  std::optional<OutputFolder> output;
  if (!folder.empty()) {
    output.emplace(folder, flight_results, scenario_to_text(scenario),
                   arguments.force ? Replace::anything : Replace::same);
    options.output_folder = output->path();
  }
  // What an option names within the run's folder appears with it; what lies elsewhere, when the run is there.
  const auto placed = [&](const fs::path& file) {
    const fs::path within = path_within(file, folder);
    return within.empty() ? file : output->path() / within;
  };
  options.track = placed(arguments.track);
  FlightLogger logger;
  const std::unique_ptr<FlightMcap> mcap = mcap_of(arguments, logger, options);
  warn_of(scenario, arguments.quiet);
  ProgressLine line(!arguments.quiet);
  options.on_progress = [&](const FlightProgress& progress) { show(line, progress); };
  if (const std::size_t obstacles = course_obstacles(scenario).size(); obstacles > 2000)
    line.show(fmt::format("building a world with {} obstacles", obstacles));
  FlightResult result;
  try {
    result = arguments.recording.form ? fly_recorded(scenario, options, arguments.recording).result
                                      : fly(scenario, options);
  } catch (const LostFilm&) {
    output->finish();
    throw;
  }
  line.clear();
  FlightRow row = flown_row(fs::path(arguments.scenario).stem().string(), scenario, result);
  if (!arguments.row.empty()) row.id = fs::path(arguments.row).stem().string();  // as the campaign asked
  std::vector<std::pair<std::string, std::string>> named;
  if (!arguments.row.empty()) named.emplace_back(arguments.row, to_json(FlightFile{row, cost_of(result)}));
  if (!arguments.junit.empty()) named.emplace_back(arguments.junit, campaign_junit({row}));
  for (const auto& [file, text] : named)
    if (placed(file) != file) write_whole_file(placed(file), text);
  if (output) output->finish();
  for (const auto& [file, text] : named)
    if (placed(file) == file) write_whole_file(file, text);
  if (!arguments.quiet) {
    fmt::print("{}", to_report(result));
    if (output) fmt::print("  {:<18}{}\n", "files", folder.string());
    if (options.video) fmt::print("  {:<18}{}\n", "video", (folder / "flight.mp4").string());
    if (options.report) fmt::print("  {:<18}{}\n", "report", (folder / "report.html").string());
  }
  return result.outcome == Outcome::goal ? exit_goal : exit_not_goal;
}

struct RecordArguments : FlightArguments {
  std::optional<double> walk_mps;  // nothing: flies
  std::string path;                // empty: none to follow
  std::optional<double> height_m;
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

/// As given, or in the source tree from any working directory: scenarios/library/paths/level.tum.
fs::path path_file(const fs::path& given) {
  std::error_code ignored;
  const fs::path in_root = data_root() / given;
  const bool only_there = !fs::exists(given, ignored) && fs::exists(in_root, ignored);
  return only_there ? in_root : given;
}

std::string record(const RecordArguments& arguments, const Scenario& scenario, FlyOptions options) {
  const std::vector<TimedPose> path =
      arguments.path.empty() ? std::vector<TimedPose>{} : read_path(path_file(arguments.path));
  ProgressLine line(!arguments.quiet);
  options.on_progress = [&](const FlightProgress& progress) { show(line, progress); };
  FlightLogger logger;
  const std::unique_ptr<FlightMcap> mcap = mcap_of(arguments, logger, options);
  if (!path.empty()) return report_of(follow_recorded(scenario, path, options, arguments.recording));
  if (!arguments.walk_mps) return report_of(fly_recorded(scenario, options, arguments.recording));
  return report_of(walk_recorded(scenario,
                                 {*arguments.walk_mps, arguments.height_m.value_or(WalkConfig{}.height_m)},
                                 options, arguments.recording));
}

int run_record(const RecordArguments& arguments) {
  if (arguments.height_m && !arguments.walk_mps) throw ScenarioError("--height requires --walk");
  if (!arguments.path.empty() && arguments.walk_mps)
    throw ScenarioError("--path and --walk exclude each other");
  if (arguments.mcap && (arguments.walk_mps || !arguments.path.empty()))
    throw ScenarioError("--mcap is a log of a flight: it excludes --walk and --path");
  const Scenario scenario = scenario_of(arguments);
  FlyOptions options = options_of(arguments);
  OutputFolder output(arguments.out, flight_results, scenario_to_text(scenario),
                      arguments.force ? Replace::anything : Replace::nothing);
  options.output_folder = output.path();
  const std::string report = record(arguments, scenario, options);
  output.finish();
  if (!arguments.quiet) fmt::print("{}  {:<18}{}\n", report, "files", arguments.out);
  return exit_goal;
}

}  // namespace

std::string renderer_of_this_machine() {
  try {
    OffscreenContext context;
    context.make_current(16, 16);
    return context.renderer();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

void add_fly_command(CommandLine& line) {
  const auto arguments = std::make_shared<FlyArguments>();
  Command& command = line.add({"fly", "fly a scenario once and write the results to a run folder",
                               "understory fly forest --seed 7 --video", "the aircraft reached the goal",
                               "the aircraft did not reach the goal"});
  add_flight_options(command, *arguments, "run folder (default: runs/SCENARIO-SEED)",
                     "the run in the folder, even if it has another configuration");
  command.text(
      "--row", "FILE", arguments->row,
      "write the flight's results as JSON, as one row of a campaign; without --out, write no run folder");
  command.text("--track", "FILE", arguments->track,
               "if the flight is lost, write its track, which a campaign's report page replays");
  command.text("--junit", "FILE", arguments->junit, "write the flight as a JUnit test case (XML)");
  command.flag(
      "--video", arguments->video,
      "also write a video (flight.mp4) and a picture of the frame with the most detections (still.png)");
  command.flag("--report", arguments->report, "also write report.html, a page with replay, charts and video");
  add_recording_options(command, "--record", arguments->recording,
                        "also record the flight as a data set, as record does: euroc, kitti or middlebury");
  command.runs([arguments] { return run_fly(*arguments); });
}

void add_record_command(CommandLine& line) {
  const auto arguments = std::make_shared<RecordArguments>();
  Command& command = line.add(
      {"record", "record images, true depth and poses of a flight, a walk or a given path as a data set",
       "understory record forest --out recordings/forest", "the recording is complete"});
  add_flight_options(command, *arguments, "folder of the recording", "the run or recording in the folder")
      .required();
  arguments->recording.form = RecordingForm::euroc;
  add_recording_options(
      command, "--format", arguments->recording,
      "layout of the data set: EuRoC, or stereo pairs with disparities as KITTI's or Middlebury's");
  command.flag_or_number("--walk", 1.4, arguments->walk_mps, 0.1, 5.0,
                         "move the cameras through the course at walking speed instead of flying; "
                         "--walk=SPEED sets the speed in m/s (default: 1.4)");
  command.text(
      "--path", "FILE", arguments->path,
      "move the cameras along the poses in a file: TUM format, EuRoC format, or a run's trajectory.csv");
  command.number(
      "--height", arguments->height_m, 0.3, 8.0,
      fmt::format("with --walk: height above the ground in metres (default: {})", WalkConfig{}.height_m));
  command.runs([arguments] { return run_record(*arguments); });
}

}  // namespace understory
