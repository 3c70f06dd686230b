#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <system_error>

#include "perception/io/machine_limits.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/output/signals.hpp"

namespace {

using namespace understory;

/// One line that a person can read, whatever a library or an argument has put into the message.
void complain(std::string message) {
  constexpr std::size_t maximum = 5000, shown_end = 500;  // a path has 4096 bytes at most
  std::ranges::replace_if(
      message, [](unsigned char c) { return c < ' ' || c == 127; }, ' ');
  while (!message.empty() && message.back() == ' ') message.pop_back();
  if (message.size() > maximum)
    message = message.substr(0, shown_end) + " ... " + message.substr(message.size() - shown_end);
  const std::string line = "understory: " + message + "\n";
  const auto lock = hold_outputs();
  std::fwrite(line.data(), 1, line.size(), stderr);  // unbuffered; where nobody reads it nothing can be done
}

/// What an error of the system means: whose fault it is, by errno.
int complain_of(const std::string& what, int error) {
  const std::string lacking = lacking_resource(error);
  complain(fmt::format("{}: {}", what, lacking.empty() ? std::strerror(error) : lacking));
  const bool is_machine =
      !lacking.empty() || error == ENOSPC || error == EDQUOT || error == EIO || error == EPIPE;
  return is_machine ? exit_machine_failed : exit_bad_input;
}

/// What was printed has reached its reader.
void require_printed() {
  errno = 0;
  const bool is_flushed = std::fflush(stdout) == 0;
  if (is_flushed && std::ferror(stdout) == 0) return;
  throw MachineError(
      fmt::format("standard output: {}", errno != 0 ? std::strerror(errno) : "what was printed is lost"));
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
      throw ScenarioError(fmt::format("completion {}: must be bash, SCENARIO or RIG", *what));
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
  add_images_command(line);
  add_campaign_command(line);
  add_shard_command(line);
  add_collect_command(line);
  add_gate_command(line);
  add_explain_command(line);
  add_tune_command(line);
  add_rig_command(line);
  add_bench_command(line);
  add_keys_command(line);
  add_forest_command(line);
  add_plugin_command(line);
  add_hidden_commands(line);
  return line.run(argc, argv);
}

}  // namespace

int main(int argc, char** argv) {
  repair_surroundings();
  understory_commit = commit_of_this_build;
  std::signal(SIGABRT, [](int) { std::_Exit(exit_machine_failed); });  // an assertion has already said why
  try {
    require_stack();
    end_on_signals();
    const int status = run(argc, argv);
    require_printed();
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
  } catch (const std::filesystem::filesystem_error& error) {
    return complain_of(error.path1().string(), error.code().value());
  } catch (const std::system_error& error) {  // of fmt: what cannot be printed
    return complain_of(std::ferror(stdout) != 0 ? "standard output" : error.what(), error.code().value());
  } catch (const std::bad_alloc&) {
    complain(lacking_resource(ENOMEM));
    return exit_machine_failed;
  } catch (const std::exception& error) {
    complain(std::string("internal fault: ") + error.what());
    return exit_machine_failed;
  }
}
