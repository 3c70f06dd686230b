#include <fmt/format.h>

#include <memory>

#include "perception/io/stereo_recording.hpp"
#include "scenarios/bench/bench.hpp"
#include "scenarios/bench/stereo_scenes.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/progress_line.hpp"

namespace understory {
namespace {

struct BenchArguments : CalibrationArguments {
  std::vector<std::string> inputs;
  std::string rig;  // empty: the later real rig, or the inputs' own
  std::string json;
  int pairs = 64;
  int rounds = 20;
  bool closed_loop = false;
  ClosedLoopBenchArguments flights;
};

std::vector<StereoFrame> recorded(const BenchArguments& arguments) {
  StereoRecording recording({arguments.inputs.begin(), arguments.inputs.end()});
  std::vector<StereoFrame> frames;
  StereoFrame frame;
  while (static_cast<int>(frames.size()) < arguments.pairs && recording.read(frame))
    frames.push_back({frame.t_ns, frame.left.clone(), frame.right.clone()});
  return frames;
}

int run_bench(BenchArguments arguments) {
  if (arguments.closed_loop) {
    arguments.flights.json = arguments.json;
    return run_closed_loop_bench(arguments.flights);
  }
  std::filesystem::path rig_file = arguments.rig;
  if (rig_file.empty())
    rig_file = arguments.inputs.empty() ? data_root() / "models" / "rigs" / "raw" / "long.xml"
                                        : std::filesystem::path(arguments.inputs.front());
  CalibratedRig rig;
  std::vector<StereoFrame> frames;
  try {
    rig = read_calibrated_rig(arguments.rig.empty() ? rig_file : rig_path(arguments.rig),
                              calibration_options(arguments));
    if (!arguments.inputs.empty()) frames = recorded(arguments);
  } catch (const std::runtime_error& error) {
    throw ScenarioError(error.what());
  }
  if (frames.empty()) frames = stereo_scenes(rig, arguments.pairs, 1);
  if (frames.front().left.cols != rig.rig.width_px || frames.front().left.rows != rig.rig.height_px)
    throw ScenarioError(fmt::format("{}: expected images of {}x{}, as the rig has them",
                                    arguments.inputs.front(), rig.rig.width_px, rig.rig.height_px));
  ProgressLine line;
  const std::vector<BenchRow> rows = bench_detectors(rig, frames, arguments.rounds, [&](int round) {
    const auto done = static_cast<std::size_t>(round), all = static_cast<std::size_t>(arguments.rounds);
    line.show(fmt::format("round {} of {}", round + 1, all), done, all - done);
  });
  line.clear();
  fmt::print("{} {} pairs, {}x{}, rig {}, looking {:.2f} m ahead\n{}", frames.size(),
             arguments.inputs.empty() ? "rendered" : "recorded", rig.rig.width_px, rig.rig.height_px,
             rig.rig.name, rig.rig.detection_depth_m, to_table(rows));
  if (!arguments.json.empty()) write_whole_file(arguments.json, to_json(rows));
  return 0;
}

}  // namespace

void add_bench_command(CommandLine& line) {
  const auto arguments = std::make_shared<BenchArguments>();
  Command& command =
      line.add({"bench", "time the detector against OpenCV's remap and matchers, or whole flights",
                "understory bench --pairs 16 --json bench.json"});
  const auto inputs = command.texts("INPUT", "FILE", arguments->inputs,
                                    "recorded pairs, as for detect (default: rendered pairs, none twice)");
  command.text("--rig", "RIG", arguments->rig,
               "as for rig (default: the long rig's raw cameras, or INPUT's own)");
  add_calibration_options(command, *arguments);
  command.whole("--pairs", arguments->pairs, 1, 10000, "how many");
  command.whole("--rounds", arguments->rounds, 1, 100000, "over all pairs");
  command.text("--json", "FILE", arguments->json, "also write the rows there");
  command
      .flag("--closed-loop", arguments->closed_loop,
            "time whole flights through the library's forests instead, alone and two side by side")
      .excludes(inputs);
  command.whole("--flights", arguments->flights.flights, 1, 1000, "with --closed-loop: of each kind");
  add_settings_option(command, arguments->flights.settings);
  add_renderer_option(command, arguments->flights.renderer);
  command.runs([arguments] { return run_bench(*arguments); });
}

}  // namespace understory
