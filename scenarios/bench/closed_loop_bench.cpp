#include "scenarios/bench/bench.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <map>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/flight/stopwatch.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/output/signals.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Batch {
  std::vector<TimedFlight> flights;
  double elapsed_s = 0;
};

/// Every seed of the scenario, `processes` at a time.
Batch fly_batch(const ClosedLoopBenchOptions& options, const fs::path& scenario, int processes,
                const std::string& setting) {
  const Unfinished runs(fs::temp_directory_path() / fmt::format("understory-bench-{}", getpid()));
  prepare_output_folder(runs.path());
  const auto run_folder = [&](std::uint64_t seed) { return runs.path() / fmt::format("{}", seed); };
  std::map<std::uint64_t, Clock::time_point> started;
  Batch batch;
  int failed_status = 0;
  ProgramProcesses flights(processes, [&](std::uint64_t seed, int status, const EndedProcess& process) {
    if (status != 0 && status != 1) {  // the goal reached or not: timed alike
      failed_status = status;
      return;
    }
    TimedFlight flight = timed_flight(run_folder(seed) / "result.json");
    flight.wall_s = seconds_since(started.at(seed));
    flight.peak_memory_mb = process.peak_memory_mb;
    flight.cpu_s = process.cpu_s;
    batch.flights.push_back(flight);
  });
  const Clock::time_point begin = Clock::now();
  for (std::uint64_t seed = options.first_seed; seed <= options.last_seed && failed_status == 0; ++seed) {
    std::vector<std::string> arguments{"fly", scenario.string(), "--quiet", "--out",
                                       run_folder(seed).string()};
    arguments.insert(arguments.end(), {"--seed", fmt::format("{}", seed)});
    arguments.insert(arguments.end(), options.arguments.begin(), options.arguments.end());
    if (!setting.empty()) arguments.insert(arguments.end(), {"--set", setting});
    flights.start(seed, arguments);
    started[seed] = Clock::now();
  }
  flights.wait_for_all();
  batch.elapsed_s = seconds_since(begin);
  if (failed_status == 2) throw ScenarioError("bench: a flight refused its input (see above)");
  if (failed_status != 0)
    throw MachineError(fmt::format("bench: a flight ended with status {}", failed_status));
  return batch;
}

}  // namespace

std::vector<ClosedLoopRow> bench_closed_loop(const ClosedLoopBenchOptions& options) {
  std::vector<ClosedLoopRow> rows;
  const auto add = [&](const std::string& name, const fs::path& scenario, int processes,
                       const std::string& setting, std::ptrdiff_t yardstick) {
    options.on_progress(name);
    const Batch batch = fly_batch(options, scenario, processes, setting);
    const ClosedLoopRow* against = yardstick < 0 ? nullptr : &rows[static_cast<std::size_t>(yardstick)];
    rows.push_back(closed_loop_row(name, processes, batch.flights, batch.elapsed_s, against));
    return std::ssize(rows) - 1;
  };
  for (const fs::path& scenario : options.scenarios) {
    const std::string name = scenario.stem().string();
    const std::ptrdiff_t alone = add(name + ", one at a time", scenario, 1, "", -1);
    add(name + ", two side by side", scenario, 2, "", alone);
  }
  const std::string name = options.scenarios.front().stem().string();
  const std::ptrdiff_t narrow =
      add(name + ", trees to 20 m aside", options.scenarios.front(), 1, "forest.half_width_m=20", -1);
  add(name + ", to 200 m: ten times the trees", options.scenarios.front(), 1, "forest.half_width_m=200",
      narrow);
  return rows;
}

}  // namespace understory
