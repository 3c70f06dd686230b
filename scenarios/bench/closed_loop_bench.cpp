#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>

#include "scenarios/bench/bench.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/flight/stopwatch.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/output/signals.hpp"
#include "scenarios/report/table.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

/// The stages whose shares are told; what is left of the wall time is "other". "setup" is the world,
/// "context" the start of the renderer: OpenGL's libraries, textures, the shaders that llvmpipe compiles.
const std::vector<std::string> told_stages{"render",  "detect", "replan",  "estimate", "control",
                                           "physics", "setup",  "context", "record"};

std::string ratio_text(double ratio, const std::string& yardstick) {
  if (ratio == 0) return "";
  if (ratio < 0.05) return fmt::format("{:.0f} times faster than {}", 1 / ratio, yardstick);
  return fmt::format("{:.2f} of {}", ratio, yardstick);
}

Json or_null(bool is_known, const auto& value) { return is_known ? Json(value) : Json(nullptr); }

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

ClosedLoopRow closed_loop_row(const std::string& name, int processes, const std::vector<TimedFlight>& flights,
                              double elapsed_s, const ClosedLoopRow* yardstick) {
  ClosedLoopRow row{name, processes, static_cast<int>(flights.size()), 0, 0, 0, {}, 0, "", 0};
  double simulated_s = 0, wall_s = 0, frames = 0;
  std::map<std::string, double> stage_s;
  for (const TimedFlight& flight : flights) {
    simulated_s += flight.simulated_s;
    wall_s += flight.wall_s;
    frames += flight.frames;
    row.cpu_per_simulated_s += flight.cpu_s;
    row.peak_memory_mb = std::max(row.peak_memory_mb, flight.peak_memory_mb);
    for (const auto& [stage, seconds] : flight.stage_s) stage_s[stage] += seconds;
  }
  row.pairs_per_s = frames / elapsed_s;
  row.render_ms = 1e3 * stage_s["render"] / frames;
  row.cpu_per_simulated_s /= simulated_s;
  row.simulated_per_s = simulated_s / elapsed_s;
  double other = 1;
  for (const std::string& stage : told_stages) {
    const double share = stage_s[stage] / wall_s;
    row.shares.emplace_back(stage, share);
    other -= share;
  }
  row.shares.emplace_back("other", other);
  if (yardstick != nullptr) {
    row.yardstick = yardstick->name;
    row.ratio = yardstick->simulated_per_s / row.simulated_per_s;
  }
  return row;
}

TimedFlight timed_flight(const std::filesystem::path& result_file) {
  try {
    const auto result = parse_json(read_file(result_file, maximum_json_bytes));
    TimedFlight flight;
    flight.simulated_s = result.at("simulated_s");
    flight.frames = result.at("frames");
    for (const auto& [stage, timing] : result.at("timings").items())
      flight.stage_s[stage] = timing.at("total_s");
    return flight;
  } catch (const nlohmann::json::exception& error) {
    throw MachineError(fmt::format("{}: {}", result_file.string(), error.what()));
  }
}

std::string to_table(const std::vector<BenchRow>& rows) {
  Table table{{"", "threads", "median ms", "p90 ms", "p99 ms", "against"}};
  const bool of_planners = std::ranges::any_of(rows, [](const BenchRow& row) { return row.p99_ratio > 0; });
  if (of_planners) table.head.emplace_back("p99 / StereoBM");
  for (const BenchRow& row : rows)
    table.add(row.name, row.threads, number_text(row.median_ms, 4), number_text(row.p90_ms, 4),
              number_text(row.p99_ms, 4), ratio_text(row.ratio, row.yardstick));
  if (of_planners)
    for (std::size_t i = 0; i < rows.size(); ++i)
      table.rows[i].push_back(rows[i].p99_ratio > 0 ? number_text(rows[i].p99_ratio, 2) : "");
  return to_text(table);
}

std::string to_json(const std::vector<BenchRow>& rows) {
  Json list = Json::array();
  for (const BenchRow& row : rows)
    list.push_back(Json{{"name", row.name},
                        {"threads", row.threads},
                        {"median_ms", row.median_ms},
                        {"p90_ms", row.p90_ms},
                        {"p99_ms", row.p99_ms},
                        {"yardstick", or_null(row.ratio > 0, row.yardstick)},
                        {"ratio", or_null(row.ratio > 0, row.ratio)},
                        {"p99_ratio", or_null(row.p99_ratio > 0, row.p99_ratio)}});
  return json_text(list, 2) + "\n";
}

std::string to_table(const std::vector<ClosedLoopRow>& rows) {
  Table table{{"", "flights", "pairs/s", "ms a pair", "cpu", "x real time"}};
  table.head.insert(table.head.end(), told_stages.begin(), told_stages.end());
  table.head.insert(table.head.end(), {"other", "MB", "time against"});
  for (const ClosedLoopRow& row : rows) {
    table.add(row.name, row.flights, number_text(row.pairs_per_s, 1), number_text(row.render_ms, 2),
              number_text(row.cpu_per_simulated_s, 3), number_text(row.simulated_per_s, 2));
    std::vector<std::string>& cells = table.rows.back();
    for (const auto& [stage, share] : row.shares) cells.push_back(fmt::format("{:.1f} %", 100 * share));
    cells.push_back(number_text(row.peak_memory_mb, 0));
    cells.push_back(ratio_text(row.ratio, row.yardstick));
  }
  return to_text(table);
}

std::string to_json(const std::vector<ClosedLoopRow>& rows) {
  Json list = Json::array();
  for (const ClosedLoopRow& row : rows) {
    Json shares;
    for (const auto& [stage, share] : row.shares) shares[stage] = share;
    list.push_back(Json{{"name", row.name},
                        {"processes", row.processes},
                        {"flights", row.flights},
                        {"pairs_per_s", row.pairs_per_s},
                        {"render_ms", row.render_ms},
                        {"cpu_per_simulated_s", row.cpu_per_simulated_s},
                        {"simulated_per_s", row.simulated_per_s},
                        {"shares", shares},
                        {"peak_memory_mb", row.peak_memory_mb},
                        {"yardstick", or_null(row.ratio > 0, row.yardstick)},
                        {"ratio", or_null(row.ratio > 0, row.ratio)}});
  }
  return json_text(list, 2) + "\n";
}

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
