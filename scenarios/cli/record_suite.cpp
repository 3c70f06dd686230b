#include <fmt/format.h>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/evaluation/evaluation_suite.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/program_processes.hpp"
#include "scenarios/output/progress_line.hpp"
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
  const std::size_t all = suite.recordings.size();
  std::size_t failed = all, done = 0, here = 0;
  ProgressLine line;
  ProgramProcesses processes(jobs, [&](std::uint64_t tag, int status, const EndedProcess&) {
    if (status != 0 && failed == all) failed = static_cast<std::size_t>(tag);
    ++done;
    line.show(fmt::format("{} of {} recorded", done, all), ++here, all - done);
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
  if (failed < all)
    throw ScenarioError(
        fmt::format("{}: expected to record {}, which failed", file.string(), suite.recordings[failed].name));
  return folders;
}

}  // namespace understory
