#include <fmt/format.h>

#include <memory>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/image_sequence.hpp"
#include "perception/io/stereo_recording.hpp"
#include "scenarios/bench/bench.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/bad_input.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/progress_line.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

struct BenchArguments : CalibrationArguments {
  std::vector<std::string> inputs;
  std::string rig;  // empty: the later real rig, or the inputs' own
  std::string json;
  int pairs = 64;
  int rounds = 20;
  bool planner = false;
  bool closed_loop = false;
  int flights = 4;                    // of each kind: seeds 1000 and on
  std::vector<std::string> settings;  // of every flight
  RendererKind renderer = RendererKind::osmesa;
};

template <typename Row>
void report(const std::vector<Row>& rows, const std::string& json) {
  fmt::print("{}", to_table(rows));
  if (!json.empty()) write_whole_file(json, to_json(rows));
}

int run_closed_loop_bench(const BenchArguments& arguments) {
  ClosedLoopBenchOptions options;
  for (const char* name : {"forest", "dense", "paper", "woods", "woods_dense"})
    options.scenarios.push_back(scenario_file(name));
  options.last_seed = options.first_seed + static_cast<std::uint64_t>(arguments.flights) - 1;
  for (const std::string& setting : arguments.settings)
    options.arguments.insert(options.arguments.end(), {"--set", setting});
  options.arguments.insert(options.arguments.end(),
                           {"--renderer", std::string(word_for(arguments.renderer))});
  ProgressLine line;
  options.on_progress = [&](const std::string& what) { line.show(what); };
  const std::vector<ClosedLoopRow> rows = bench_closed_loop(options);
  line.clear();
  report(rows, arguments.json);
  return exit_goal;
}

int run_planner_bench(const BenchArguments& arguments) {
  std::vector<PlannerProblems> problems;
  for (const char* name : {"dense", "woods_dense", "paper_depths"}) {
    const std::filesystem::path file =
        data_root() / fmt::format("scenarios/library/problems/{}.csv.zst", name);
    const auto text = unpacked(read_file(file, maximum_table_bytes), maximum_table_bytes);
    if (!text) throw ScenarioError(fmt::format("{}: is damaged", file.string()));
    problems.push_back({load_scenario(scenario_file(name), arguments.settings), file.string(), *text});
  }
  const CalibratedRig rig = read_calibrated_rig(rig_path("long"), {});
  const std::vector<StereoFrame> frames = stereo_scenes(rig, arguments.pairs, 1);
  ProgressLine line;
  const std::vector<BenchRow> rows = bench_planner(problems, frames, arguments.rounds, [&](int round) {
    const auto done = static_cast<std::size_t>(round), all = static_cast<std::size_t>(arguments.rounds);
    line.show(fmt::format("round {} of {}", round + 1, all), done, all - done);
  });
  line.clear();
  report(rows, arguments.json);
  return exit_goal;
}

std::vector<StereoFrame> recorded(const BenchArguments& arguments) {
  StereoRecording recording({arguments.inputs.begin(), arguments.inputs.end()});
  std::vector<StereoFrame> frames;
  StereoFrame frame;
  while (static_cast<int>(frames.size()) < arguments.pairs && recording.read(frame))
    frames.push_back({frame.t_ns, frame.left.clone(), frame.right.clone()});
  return frames;
}

int run_bench(const BenchArguments& arguments) {
  std::vector<std::filesystem::path> read{arguments.inputs.begin(), arguments.inputs.end()};
  read.emplace_back(arguments.rig);
  require_separate({arguments.json}, read);
  require_writable(arguments.json);
  if (arguments.closed_loop) return run_closed_loop_bench(arguments);
  if (arguments.planner) return run_planner_bench(arguments);
  if (!arguments.settings.empty()) throw ScenarioError("--set: requires --closed-loop or --planner");
  if (arguments.rig.empty() && !arguments.inputs.empty() && !euroc_folder(arguments.inputs.front()))
    throw ScenarioError(fmt::format("{}: requires --rig: only EuRoC folders bring their calibration",
                                    arguments.inputs.front()));
  const std::filesystem::path rig_file = !arguments.rig.empty() ? rig_path(arguments.rig)
                                         : arguments.inputs.empty()
                                             ? data_root() / "models/rigs/raw/long.xml"
                                             : std::filesystem::path(arguments.inputs.front());
  const CalibrationOptions options = calibration_options(arguments);
  const CalibratedRig rig = bad_input_if_refused([&] { return read_calibrated_rig(rig_file, options); });
  std::vector<StereoFrame> frames;
  if (!arguments.inputs.empty()) frames = bad_input_if_refused([&] { return recorded(arguments); });
  if (frames.empty()) frames = stereo_scenes(rig, arguments.pairs, 1);
  if (frames.front().left.cols != rig.rig.width_px || frames.front().left.rows != rig.rig.height_px)
    throw ScenarioError(fmt::format("{}: images must have the size of the rig's, {}x{}",
                                    arguments.inputs.front(), rig.rig.width_px, rig.rig.height_px));
  ProgressLine line;
  const std::vector<BenchRow> rows = bench_detectors(rig, frames, arguments.rounds, [&](int round) {
    const auto done = static_cast<std::size_t>(round), all = static_cast<std::size_t>(arguments.rounds);
    line.show(fmt::format("round {} of {}", round + 1, all), done, all - done);
  });
  line.clear();
  fmt::print("{} {} pairs, {}x{}, rig {}, looking {:.2f} m ahead\n", frames.size(),
             arguments.inputs.empty() ? "rendered" : "recorded", rig.rig.width_px, rig.rig.height_px,
             rig.rig.name, rig.rig.detection_depth_m);
  report(rows, arguments.json);
  return exit_goal;
}

}  // namespace

void add_bench_command(CommandLine& line) {
  const auto arguments = std::make_shared<BenchArguments>();
  Command& command = line.add(
      {"bench", "time the detector against OpenCV's remap, StereoBM and StereoSGBM, or time whole flights",
       "understory bench --pairs 16 --json bench.json"});
  const auto inputs =
      command.texts("INPUT", "FILE", arguments->inputs,
                    "recorded stereo pairs, in any form that detect accepts (default: rendered pairs)");
  const auto rig =
      command.text("--rig", "RIG", arguments->rig,
                   "rig or calibration file, in any form that understory rig accepts (default: INPUT's "
                   "calibration, or the raw cameras of the long rig)");
  add_calibration_options(command, *arguments);
  const auto pairs = command.whole("--pairs", arguments->pairs, 1, 10000,
                                   "number of pairs to render, or largest number to read from INPUT");
  command.whole("--rounds", arguments->rounds, 1, 100000, "number of times that all pairs are timed");
  command.text("--json", "FILE", arguments->json, "also write the table as JSON");
  const auto closed_loop =
      command
          .flag(
              "--closed-loop", arguments->closed_loop,
              "time whole flights in the library's forests, first one flight at a time, then two in parallel")
          .excludes(inputs)
          .excludes(rig)
          .excludes(pairs);
  command
      .flag("--planner", arguments->planner,
            "time the planner on 504 recorded problems from flights, against StereoBM")
      .excludes(inputs)
      .excludes(rig)
      .excludes(closed_loop);
  command
      .whole("--flights", arguments->flights, 1, 1000, "with --closed-loop: number of flights in each forest")
      .needs(closed_loop);
  command.texts(
      "--set", "KEY=VALUE", arguments->settings,
      "with --closed-loop or --planner: override a key of the scenarios, for example forest.length_m=30 or "
      "autopilot.method=est; repeatable");
  add_renderer_option(command, arguments->renderer);
  command.runs([arguments] { return run_bench(*arguments); });
}

}  // namespace understory
