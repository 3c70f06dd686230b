#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "scenarios/cli/commands.hpp"
#include "scenarios/config_tree.hpp"
#include "scenarios/file_output.hpp"
#include "scenarios/versions.hpp"

namespace {

using namespace understory;

/// A seed is a setting like any other, only more often given.
void add_scenario_options(CLI::App& command, std::string& scenario, std::vector<std::string>& settings) {
  command.add_option("scenario", scenario, "a scenario file, or a name from scenarios/library")->required();
  command.add_option("--set", settings, "key=value, as in the scenario file: forest.length_m=30")
      ->allow_extra_args(false)
      ->trigger_on_parse(false);
}

/// One line, whatever a library has put into its message.
void complain(std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  while (!message.empty() && message.back() == ' ') message.pop_back();
  fmt::print(stderr, "understory: {}\n", message);
}

int run(int argc, char** argv) {
  CLI::App app("Understory: a small delta wing flies through forests on its own stereo vision");
  app.set_version_flag("--version", std::string(understory_version));
  app.require_subcommand(1);

  FlyArguments fly;
  CLI::App* fly_command = app.add_subcommand("fly", "fly a scenario once");
  add_scenario_options(*fly_command, fly.scenario, fly.settings);
  std::string seed;
  fly_command->add_option("--seed", seed, "of course and sensors; goes before the scenario's own");
  fly_command->add_option("--out", fly.out, "run folder (default: runs/<name>-<seed>)");
  fly_command->add_flag("--video", fly.video, "also make flight.mp4 and still.png");
  fly_command->add_flag("--quiet", fly.quiet, "print nothing");

  EvaluateArguments evaluate;
  CLI::App* evaluate_command =
      app.add_subcommand("evaluate", "fly a scenario over many seeds, a process each");
  add_scenario_options(*evaluate_command, evaluate.scenario, evaluate.settings);
  evaluate_command->add_option("--seeds", evaluate.seeds, "first:last")->capture_default_str();
  evaluate_command->add_option("--jobs", evaluate.jobs, "flights at a time")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  evaluate_command->add_option("--csv", evaluate.csv,
                               "a row per seed; rows already there are not flown again");
  evaluate_command->add_option("--out", evaluate.out, "keep the run folders here");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw ScenarioError(fmt::format("{} (understory --help says what there is)", error.what()));
  }
  if (!seed.empty()) fly.settings.push_back("seed=" + seed);
  return fly_command->parsed() ? run_fly(fly) : run_evaluate(evaluate);
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGABRT, [](int) { std::_Exit(exit_machine_failed); });  // an assertion has already said why
  try {
    const int status = run(argc, argv);
    if (std::fflush(stdout) != 0) throw MachineError("standard output: No space left, or its reader is gone");
    return status;
  } catch (const ScenarioError& error) {
    complain(error.what());
    return exit_bad_input;
  } catch (const MachineError& error) {
    complain(error.what());
    return exit_machine_failed;
  } catch (const std::exception& error) {
    complain(std::string("internal fault: ") + error.what());
    return exit_machine_failed;
  }
}
