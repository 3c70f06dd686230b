#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/versions.hpp"

namespace {

using namespace understory;

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

  Command chosen;
  add_fly_command(app, chosen);
  add_record_command(app, chosen);
  add_campaign_command(app, chosen);
  add_tune_command(app, chosen);
  add_shard_command(app, chosen);
  add_collect_command(app, chosen);
  add_gate_command(app, chosen);
  add_validate_command(app, chosen);
  add_rig_command(app, chosen);
  add_detect_command(app, chosen);
  add_evaluate_command(app, chosen);
  add_bench_command(app, chosen);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw ScenarioError(fmt::format("{} (understory --help says what there is)", error.what()));
  }
  return chosen();
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
