#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/bench/bench_rows.hpp"

namespace understory {

struct ClosedLoopBenchOptions {
  /// Each flown one at a time, then two side by side; the first also with ten times the trees, far and wide.
  std::vector<std::filesystem::path> scenarios;
  std::uint64_t first_seed = 1000, last_seed = 1003;
  std::vector<std::string> arguments;  ///< of every flight: --set, --renderer
  std::function<void(const std::string& what)> on_progress = [](const std::string&) {};
};

/// Times whole flights, a process each, in the machine's own time: only rows of one run on an idle machine
/// mean anything together. A flight with ten times the trees is as long and as dense as its yardstick: the
/// forest reaches 200 m to either side instead of 20. Throws ScenarioError where a flight refuses its input,
/// MachineError where one breaks.
std::vector<ClosedLoopRow> bench_closed_loop(const ClosedLoopBenchOptions& options);

}  // namespace understory
