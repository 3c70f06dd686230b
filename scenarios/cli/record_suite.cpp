#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "scenarios/bench/flight_processes.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/evaluation/evaluation_suite.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// Before anything is recorded: what a child process would refuse.
void check(const EvaluationSuite& suite, const fs::path& file) {
  for (const SuiteRecording& recording : suite.recordings) {
    try {
      rig_of(load_scenario(recording.scenario, recording.settings), data_root() / "models");
    } catch (const ScenarioError& error) {
      throw ScenarioError(fmt::format("{}: {}: {}", file.string(), recording.name, error.what()));
    }
  }
}

std::vector<std::string> arguments_of(const SuiteRecording& recording, const fs::path& folder) {
  std::vector<std::string> arguments{"record", recording.scenario.string(), "--quiet", "--out",
                                     folder.string()};
  arguments.insert(arguments.end(), recording.arguments.begin(), recording.arguments.end());
  for (const std::string& setting : recording.settings) arguments.insert(arguments.end(), {"--set", setting});
  return arguments;
}

}  // namespace

std::vector<fs::path> record_suite(const fs::path& file, const fs::path& folder, int jobs) {
  const EvaluationSuite suite = load_evaluation_suite(file, scenario_file);
  check(suite, file);
  prepare_output_folder(folder);
  std::size_t failed = suite.recordings.size(), done = 0;
  const bool terminal = isatty(STDOUT_FILENO) == 1;
  FlightProcesses processes(jobs, [&](std::uint64_t tag, int status) {
    if (status != 0 && failed == suite.recordings.size()) failed = static_cast<std::size_t>(tag);
    ++done;
    if (!terminal) return;
    fmt::print("\r\033[K{} of {} recorded", done, suite.recordings.size());
    std::fflush(stdout);
  });
  std::vector<fs::path> folders;
  for (const SuiteRecording& recording : suite.recordings) {
    folders.push_back(folder / recording.name);
    if (fs::exists(folders.back() / "mav0")) {  // it bears that name only when it is whole
      ++done;
      continue;
    }
    processes.start(folders.size() - 1, arguments_of(recording, folders.back()));
  }
  processes.wait_for_all();
  if (terminal) fmt::print("\r\033[K");
  if (failed < suite.recordings.size())
    throw ScenarioError(
        fmt::format("{}: expected to record {}, which failed", file.string(), suite.recordings[failed].name));
  return folders;
}

}  // namespace understory
