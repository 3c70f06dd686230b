#include <fmt/format.h>

#include "scenarios/bench/closed_loop_bench.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/progress_line.hpp"

namespace understory {

int run_closed_loop_bench(const ClosedLoopBenchArguments& arguments) {
  ClosedLoopBenchOptions options;
  for (const char* name : {"forest", "dense", "paper"}) options.scenarios.push_back(scenario_file(name));
  options.sparse = scenario_file("forest");
  options.last_seed = options.first_seed + static_cast<std::uint64_t>(arguments.flights) - 1;
  for (const std::string& setting : arguments.settings)
    options.arguments.insert(options.arguments.end(), {"--set", setting});
  options.arguments.insert(options.arguments.end(),
                           {"--renderer", std::string(word_for(arguments.renderer))});
  ProgressLine line;
  options.on_progress = [&](const std::string& what) { line.show(what); };
  const std::vector<ClosedLoopRow> rows = bench_closed_loop(options);
  line.clear();
  fmt::print("{}", to_table(rows));
  if (!arguments.json.empty()) write_whole_file(arguments.json, to_json(rows));
  return 0;
}

}  // namespace understory
