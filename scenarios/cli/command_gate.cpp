#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/campaign/gate.hpp"
#include "scenarios/campaign/junit.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

struct GateArguments {
  std::string baseline;
  std::string candidate;
  std::string junit;
  GateRule rule;
};

int run_gate(const GateArguments& arguments) {
  if (!(arguments.rule.max_drop >= 0 && arguments.rule.max_drop <= 1))  // NaN would let everything pass
    throw ScenarioError(fmt::format("--max-drop {}: expected a share from 0 to 1", arguments.rule.max_drop));
  const Comparison comparison =
      compare_campaigns(read_campaign_rows(arguments.baseline), read_campaign_rows(arguments.candidate));
  const GateVerdict verdict = judge(comparison, arguments.rule);
  if (!arguments.junit.empty()) write_whole_file(arguments.junit, gate_junit(comparison, arguments.rule));
  fmt::print("{}", to_report(comparison, verdict, arguments.rule));
  return verdict.passes() ? exit_goal : exit_not_goal;
}

}  // namespace

void add_gate_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<GateArguments>();
  CLI::App* command =
      app.add_subcommand("gate", "compare two campaigns seed by seed; status 1 where success fell too far");
  command->add_option("--baseline", arguments->baseline, "campaign folder of the program before the change")
      ->required();
  command->add_option("--candidate", arguments->candidate, "campaign folder of the program with the change")
      ->required();
  command->add_option("--max-drop", arguments->rule.max_drop, "share of goals that any condition may lose")
      ->capture_default_str();
  command->add_option("--junit", arguments->junit, "write a test case per flight as JUnit XML");
  command->callback([arguments, &chosen] { chosen = [arguments] { return run_gate(*arguments); }; });
}

}  // namespace understory
