#include <fmt/format.h>

#include <memory>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/campaign/gate.hpp"
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
  require_writable(arguments.junit);
  const Comparison comparison =
      compare_campaigns(read_campaign_rows(arguments.baseline), read_campaign_rows(arguments.candidate));
  const GateVerdict verdict = judge(comparison, arguments.rule);
  if (!arguments.junit.empty()) write_whole_file(arguments.junit, gate_junit(comparison, arguments.rule));
  fmt::print("{}", to_report(comparison, verdict, arguments.rule));
  return verdict.passes() ? exit_goal : exit_not_goal;
}

}  // namespace

void add_gate_command(CommandLine& line) {
  const auto arguments = std::make_shared<GateArguments>();
  Command& command = line.add({"gate", "compare two campaigns seed by seed",
                               "understory gate --baseline results/before --candidate results/after",
                               "the change may pass", "success fell too far"});
  command.text("--baseline", "FOLDER", arguments->baseline, "campaign of the program before the change")
      .required();
  command.text("--candidate", "FOLDER", arguments->candidate, "campaign of the program with the change")
      .required();
  command.number("--max-drop", arguments->rule.max_drop, 0, 1, "share of goals that any condition may lose");
  command.text("--junit", "FILE", arguments->junit, "write a test case per flight as JUnit XML");
  command.runs([arguments] { return run_gate(*arguments); });
}

}  // namespace understory
