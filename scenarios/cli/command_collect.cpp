#include <fmt/format.h>

#include <memory>

#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/campaign/campaign_summary.hpp"
#include "scenarios/campaign/gate.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/folder_mark.hpp"

namespace understory {
namespace {

struct GateArguments {
  std::string baseline;
  std::string candidate;
  std::string junit;
  GateRule rule;
};

int run_gate(const GateArguments& arguments) {
  for (const std::string& folder : {arguments.baseline, arguments.candidate}) {
    require_outside(arguments.junit, folder);
  }
  require_writable(arguments.junit);
  const Comparison comparison =
      compare_campaigns(read_campaign_rows(arguments.baseline), read_campaign_rows(arguments.candidate));
  const GateVerdict verdict = verdict_on(comparison, arguments.rule);
  if (!arguments.junit.empty()) write_whole_file(arguments.junit, gate_junit(comparison, arguments.rule));
  fmt::print("{}", to_report(comparison, verdict, arguments.rule));
  return verdict.passes() ? exit_goal : exit_not_goal;
}

}  // namespace

int report(const CampaignFolder& folder, const Campaign& campaign, const Collected& collected,
           const std::filesystem::path& junit) {
  const Table table = summary_table(summarise(collected.rows));
  write_whole_file(folder.path / "summary.md", to_markdown(table));
  const std::string plots = campaign_svg(collected.rows, campaign.conditions);
  if (!plots.empty()) write_whole_file(folder.path / "campaign.svg", plots);
  if (!junit.empty()) write_whole_file(junit, campaign_junit(collected.rows));

  fmt::print("{}", to_text(table));
  std::size_t not_flown = 0;
  for (const FlightRow& row : collected.rows) {
    if (row.flown()) continue;
    if (++not_flown <= 10) fmt::print("not flown: {}: {}\n", row.id, row.reason);
  }
  if (not_flown > 10) fmt::print("not flown: {} more, see flights.csv\n", not_flown - 10);
  if (collected.missing > 0) fmt::print("missing: {} flights\n", collected.missing);
  fmt::print("rows and plots: {}\n", folder.path.string());
  return not_flown == 0 && collected.missing == 0 ? exit_goal : exit_not_goal;
}

void add_collect_command(CommandLine& line) {
  const auto folder = std::make_shared<std::string>();
  Command& command = line.add({"collect", "gather the results of a campaign's flights into tables",
                               "understory collect results/gate", "every flight was flown",
                               "a flight is missing or could not be flown"});
  command.text("folder", "FOLDER", *folder, "results folder of the campaign").required();
  command.runs([folder] {
    const CampaignFolder results{*folder};
    const Campaign campaign = read_campaign(results);
    FolderMark mark(results.path, campaign_results, results.path, FolderMark::Manner::beside_others);
    mark.add_names();
    return report(results, campaign, collect(results, campaign));
  });
}

void add_gate_command(CommandLine& line) {
  const auto arguments = std::make_shared<GateArguments>();
  Command& command =
      line.add({"gate", "compare two campaigns flight by flight and say whether a change may pass",
                "understory gate --baseline results/before --candidate results/after", "the change may pass",
                "success dropped too far, or flights are missing or could not be flown"});
  command
      .text("--baseline", "FOLDER", arguments->baseline, "results folder of the campaign before the change")
      .required();
  command
      .text("--candidate", "FOLDER", arguments->candidate, "results folder of the campaign with the change")
      .required();
  command.number("--max-drop", arguments->rule.max_drop, 0, 1,
                 "fail if, in any condition, the share of flights that reach the goal drops by more than X");
  command.text("--junit", "FILE", arguments->junit, "write the comparison as JUnit test cases (XML)");
  command.runs([arguments] { return run_gate(*arguments); });
}

}  // namespace understory
