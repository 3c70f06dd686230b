#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/output/signals.hpp"

namespace {

using namespace understory;

/// One line, whatever a library has put into its message.
void complain(std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  while (!message.empty() && message.back() == ' ') message.pop_back();
  const auto lock = hold_outputs();
  fmt::print(stderr, "understory: {}\n", message);
}

std::string version() {
  return fmt::format("understory {} ({})\nrenderer: {}", understory_version, understory_commit,
                     renderer_of_this_machine());
}

/// For packages and shells: `understory manual`, `understory completion bash`, and what the latter's script
/// asks for.
void add_hidden_commands(CommandLine& line) {
  Command& manual = line.add({"manual", "print the manual page", "understory manual | man -l -"});
  manual.hide();
  manual.runs([&line] {
    fmt::print("{}", manual_page(line.commands()));
    return exit_goal;
  });
  const auto what = std::make_shared<std::string>();
  Command& completion =
      line.add({"completion", "print a script of completions", "understory completion bash"});
  completion.hide();
  completion.text("what", "WORD", *what, "bash, SCENARIO or RIG").required();
  completion.runs([&line, what] {
    if (*what == "bash")
      fmt::print("{}", bash_completion(line.commands()));
    else if (*what == "SCENARIO" || *what == "RIG")
      fmt::print("{}\n", fmt::join(*what == "RIG" ? rig_names() : scenario_names(), "\n"));
    else
      throw ScenarioError(fmt::format("completion {}: expected bash, SCENARIO or RIG", *what));
    return exit_goal;
  });
}

int run(int argc, char** argv) {
  CommandLine line(version);
  add_fly_command(line);
  add_record_command(line);
  add_report_command(line);
  add_mcap_command(line);
  add_detect_command(line);
  add_evaluate_command(line);
  add_campaign_command(line);
  add_shard_command(line);
  add_collect_command(line);
  add_gate_command(line);
  add_tune_command(line);
  add_rig_command(line);
  add_bench_command(line);
  add_keys_command(line);
  add_hidden_commands(line);
  return line.run(argc, argv);
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGABRT, [](int) { std::_Exit(exit_machine_failed); });  // an assertion has already said why
  try {
    end_on_signals();
    const int status = run(argc, argv);
    if (std::fflush(stdout) != 0) throw MachineError("standard output: No space left, or its reader is gone");
    return status;
  } catch (const ScenarioError& error) {
    complain(error.what());
    return exit_bad_input;
  } catch (const MachineError& error) {
    complain(error.what());
    return exit_machine_failed;
  } catch (const Stopped& error) {
    complain(error.what());
    return 128 + error.signal;
  } catch (const std::exception& error) {
    complain(std::string("internal fault: ") + error.what());
    return exit_machine_failed;
  }
}
