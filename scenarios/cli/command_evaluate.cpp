#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>

#include "scenarios/cli/commands.hpp"
#include "scenarios/evaluation/flight_table.hpp"
#include "scenarios/evaluation/processes.hpp"
#include "scenarios/file_output.hpp"
#include "scenarios/run_digest.hpp"
#include "scenarios/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

struct EvaluateArguments : ScenarioArguments {
  std::string seeds = "1000:1099";  // first:last, or one
  std::string csv;                  // empty: no file; with one, seeds it already answers are not flown again
  std::string out;                  // keeps the run folders here; empty: they are removed
  int jobs = 1;
};

struct SeedRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

SeedRange seed_range(const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto number = [&](const std::string& part) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || end != part.data() + part.size() || value > std::uint64_t{1} << 32) {
      throw ScenarioError(fmt::format("--seeds {}: expected first:last, for instance 1000:1099", text));
    }
    return value;
  };
  const SeedRange range{number(text.substr(0, colon)),
                        number(colon == std::string::npos ? text : text.substr(colon + 1))};
  if (range.first > range.last) throw ScenarioError(fmt::format("--seeds {}: expected first <= last", text));
  return range;
}

/// Equal for equal scenarios (but for the seed) flown by the same program.
std::string configuration_of(Scenario scenario) {
  scenario.seed = 0;
  RunDigest digest;
  const std::string text = scenario_to_text(scenario);
  digest.add(std::as_bytes(std::span(text)));
  std::ifstream program("/proc/self/exe", std::ios::binary);
  std::ostringstream bytes;
  bytes << program.rdbuf();
  const std::string binary = bytes.str();
  digest.add(std::as_bytes(std::span(binary)));
  return digest.hex();
}

std::vector<std::string> flight_arguments(const EvaluateArguments& arguments, const fs::path& file,
                                          std::uint64_t seed, const fs::path& folder) {
  std::vector<std::string> all{"fly", file.string(), "--quiet", "--out", folder.string()};
  for (const std::string& setting : arguments.settings) all.insert(all.end(), {"--set", setting});
  all.insert(all.end(), {"--seed", fmt::format("{}", seed)});
  return all;
}

int run_evaluate(const EvaluateArguments& arguments) {
  const fs::path file = scenario_file(arguments.scenario);
  const SeedRange seeds = seed_range(arguments.seeds);
  FlightTable table(configuration_of(load_scenario(file, arguments.settings)));
  if (!arguments.csv.empty()) table.read(arguments.csv);
  const bool keeps_runs = !arguments.out.empty();
  const fs::path runs = keeps_runs
                            ? fs::path(arguments.out)
                            : fs::temp_directory_path() / fmt::format("understory-evaluate-{}", getpid());
  prepare_output_folder(runs);
  const auto run_folder = [&](std::uint64_t seed) { return runs / fmt::format("{}", seed); };
  const bool shows_progress = isatty(STDOUT_FILENO) == 1;
  int failed_status = 0;

  Processes flights(arguments.jobs, [&](std::uint64_t seed, int status) {
    if (status != exit_goal && status != exit_not_goal) {
      failed_status = status;
      return;
    }
    table.add_result(run_folder(seed) / "result.json");
    if (!arguments.csv.empty()) write_whole_file(arguments.csv, table.to_csv());
    if (!keeps_runs) fs::remove_all(run_folder(seed));
    if (!shows_progress) return;
    const std::string so_far = table.summary(seeds.first, seeds.last);
    fmt::print("\r\033[K{}", so_far.substr(0, so_far.find('\n')));
    std::fflush(stdout);
  });
  for (std::uint64_t seed = seeds.first; seed <= seeds.last && failed_status == 0; ++seed) {
    if (!table.has(seed)) flights.start(seed, flight_arguments(arguments, file, seed, run_folder(seed)));
  }
  flights.wait_for_all();
  if (!keeps_runs) fs::remove_all(runs);
  if (shows_progress) fmt::print("\r\033[K");
  if (failed_status == exit_bad_input)
    throw ScenarioError("evaluate: a flight refused its input (see above)");
  if (failed_status != 0)
    throw MachineError(fmt::format("evaluate: a flight ended with status {}", failed_status));
  fmt::print("{}", table.summary(seeds.first, seeds.last));
  return 0;
}

}  // namespace

void add_evaluate_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = app.add_subcommand("evaluate", "fly a scenario over many seeds, a process each");
  add_scenario_options(*command, *arguments);
  command->add_option("--seeds", arguments->seeds, "first:last")->capture_default_str();
  command->add_option("--jobs", arguments->jobs, "flights at a time")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  command->add_option("--csv", arguments->csv, "a row per seed; rows already there are not flown again");
  command->add_option("--out", arguments->out, "keep the run folders here");
  command->callback([arguments, &chosen] { chosen = [arguments] { return run_evaluate(*arguments); }; });
}

}  // namespace understory
