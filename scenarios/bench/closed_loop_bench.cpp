#include "scenarios/bench/closed_loop_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scenarios/output/file_output.hpp"

namespace understory {

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
    std::ifstream file(result_file);
    const auto result = nlohmann::json::parse(file);
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

std::string to_table(const std::vector<ClosedLoopRow>& rows) {
  std::string text =
      fmt::format("{:<42}{:>8}{:>9}{:>7}{:>13}", "", "flights", "pairs/s", "cpu", "x real time");
  for (const std::string& stage : told_stages) text += fmt::format("{:>9}", stage);
  text += fmt::format("{:>8}{:>7}  {}\n", "other", "MB", "time against");
  for (const ClosedLoopRow& row : rows) {
    text += fmt::format("{:<42}{:>8}{:>9.1f}{:>7.3f}{:>13.2f}", row.name, row.flights, row.pairs_per_s,
                        row.cpu_per_simulated_s, row.simulated_per_s);
    for (const auto& [stage, share] : row.shares)
      text += fmt::format("{:>{}.1f} %", 100 * share, stage == "other" ? 6 : 7);
    text += fmt::format("{:>7.0f}", row.peak_memory_mb);
    if (row.ratio > 0) text += fmt::format("  {:.2f} of {}", row.ratio, row.yardstick);
    text += "\n";
  }
  return text;
}

std::string to_json(const std::vector<ClosedLoopRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ClosedLoopRow& row : rows) {
    nlohmann::ordered_json one{{"name", row.name},
                               {"processes", row.processes},
                               {"flights", row.flights},
                               {"pairs_per_s", row.pairs_per_s},
                               {"cpu_per_simulated_s", row.cpu_per_simulated_s},
                               {"simulated_per_s", row.simulated_per_s}};
    for (const auto& [stage, share] : row.shares) one["shares"][stage] = share;
    one["peak_memory_mb"] = row.peak_memory_mb;
    one["yardstick"] = nullptr;
    one["ratio"] = nullptr;
    if (row.ratio > 0) one["yardstick"] = row.yardstick, one["ratio"] = row.ratio;
    list.push_back(one);
  }
  return list.dump(2) + "\n";
}

}  // namespace understory
