#include "scenarios/bench/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scenarios/config/json_text.hpp"
#include "scenarios/output/file_output.hpp"
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
  Table table{{"", "threads", "median ms", "p90", "p99", "against"}};
  for (const BenchRow& row : rows)
    table.add(row.name, row.threads, number_text(row.median_ms, 4), number_text(row.p90_ms, 4),
              number_text(row.p99_ms, 4), ratio_text(row.ratio, row.yardstick));
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
                        {"ratio", or_null(row.ratio > 0, row.ratio)}});
  return list.dump(2) + "\n";
}

std::string to_table(const std::vector<ClosedLoopRow>& rows) {
  Table table{{"", "flights", "pairs/s", "cpu", "x real time"}};
  table.head.insert(table.head.end(), told_stages.begin(), told_stages.end());
  table.head.insert(table.head.end(), {"other", "MB", "time against"});
  for (const ClosedLoopRow& row : rows) {
    table.add(row.name, row.flights, number_text(row.pairs_per_s, 1), number_text(row.cpu_per_simulated_s, 3),
              number_text(row.simulated_per_s, 2));
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
                        {"cpu_per_simulated_s", row.cpu_per_simulated_s},
                        {"simulated_per_s", row.simulated_per_s},
                        {"shares", shares},
                        {"peak_memory_mb", row.peak_memory_mb},
                        {"yardstick", or_null(row.ratio > 0, row.yardstick)},
                        {"ratio", or_null(row.ratio > 0, row.ratio)}});
  }
  return list.dump(2) + "\n";
}

}  // namespace understory
