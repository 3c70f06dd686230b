#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <memory>

#include "scenarios/campaign/campaign_page.hpp"
#include "scenarios/campaign/campaign_summary.hpp"
#include "scenarios/campaign/gate.hpp"
#include "scenarios/campaign/gate_history.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/signals.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

struct GateArguments {
  std::string task;  // "plan"; empty: judge
  std::string baseline, candidate, baseline_program;
  std::vector<std::string> between, history, tolerances;
  std::string junit, json, markdown, page;  // files; empty: none
  GateRule rule;
  double power = 0.8;
  int limit = 1000;
  bool extend = false;
};

/// The flights of one condition, which get another's name.
std::vector<FlightRow> rows_of(const ComparedCampaign& campaign, const std::string& condition,
                               const std::string& called) {
  std::vector<std::string> names;
  for (const Condition& one : campaign.campaign.conditions) names.push_back(one.name);
  if (std::ranges::find(names, condition) == names.end())
    throw ScenarioError(
        fmt::format("--between {}: the campaign's conditions are {}", condition, fmt::join(names, ", ")));
  std::vector<FlightRow> rows;
  std::ranges::copy_if(campaign.rows, std::back_inserter(rows),
                       [&](const FlightRow& row) { return row.condition == condition; });
  for (FlightRow& row : rows) row.condition = called;
  return rows;
}

/// Runs a program until it ends. Throws Stopped where a signal ended it, MachineError where it failed.
void run_program(const fs::path& program, const std::vector<std::string>& arguments) {
  const pid_t child = start_this_program(arguments, SIGTERM, {}, program);
  ends_with_us(child);
  const EndedProcess ended = wait_for_process(child);
  has_ended(child);
  const int status = WIFEXITED(ended.wait_status) ? WEXITSTATUS(ended.wait_status) : exit_machine_failed;
  if (status > 128) throw Stopped(status - 128, "stopped; the same command goes on");
  if (status > exit_not_goal)
    throw MachineError(
        fmt::format("{} {}: ended with status {}", program.string(), fmt::join(arguments, " "), status));
}

/// Both sides as they are now, and what the gate says of them.
struct Judged {
  ComparedCampaign baseline, candidate;
  Comparison comparison;
  GateVerdict verdict;
};

Judged judged(const GateArguments& arguments) {
  Judged result{{}, read_compared(arguments.candidate), {}, {}};
  std::optional<std::string> drawn;
  if (arguments.between.empty()) {
    result.baseline = read_compared(arguments.baseline);
    drawn = drawn_differently(result.baseline.campaign, result.candidate.campaign);
  } else {  // the second condition's name stands for both
    result.baseline = result.candidate;
    result.baseline.rows = rows_of(result.candidate, arguments.between[0], arguments.between[1]);
    result.candidate.rows = rows_of(result.candidate, arguments.between[1], arguments.between[1]);
  }
  result.comparison = compare_campaigns(result.baseline.rows, result.candidate.rows, drawn);
  result.verdict = verdict_on(result.comparison, arguments.rule);
  return result;
}

/// Flies `count` more seeds of both campaigns, or prints the commands where the baseline's program is not
/// known: false.
bool fly_more(const GateArguments& arguments, const Judged& now, int count) {
  const Identity& identity = now.baseline.campaign.identity;
  const bool is_ours =
      std::ranges::find(identity, Identity::value_type("program", program_digest())) != identity.end();
  const std::string self = fs::read_symlink("/proc/self/exe").string();
  const std::string before =
      arguments.baseline_program.empty() && is_ours ? self : arguments.baseline_program;
  const std::uint64_t last =
      std::max(std::ranges::max(now.baseline.campaign.seeds), std::ranges::max(now.candidate.campaign.seeds));
  const std::string seeds = fmt::format("--seeds={}..{}", last + 1, last + static_cast<std::uint64_t>(count));
  const auto command = [&](const std::string& folder) {
    return std::vector<std::string>{"campaign", folder, "--resume", seeds};
  };
  if (before.empty() && arguments.between.empty()) {
    fmt::print(
        "Fly more with these commands (the first one with the program of the baseline; "
        "--baseline-program PROGRAM does it here):\n  understory {}\n  understory {}\n",
        fmt::join(command(arguments.baseline), " "), fmt::join(command(arguments.candidate), " "));
    return false;
  }
  std::fflush(stdout);
  if (arguments.between.empty()) run_program(before, command(arguments.baseline));
  run_program(self, command(arguments.candidate));
  return true;
}

/// Judges, and with --extend flies on until a verdict or the limit.
Judged judge_until_known(const GateArguments& arguments) {
  Judged result = judged(arguments);
  while (arguments.extend && result.verdict.verdict == Verdict::undecided) {
    const int conditions = static_cast<int>(result.comparison.conditions.size());
    const int pairs = result.comparison.all.goals.pairs(), left = (arguments.limit - pairs) / conditions;
    const int asked = result.verdict.more_pairs == 0 ? pairs : result.verdict.more_pairs;
    const int seeds = std::min(left, (asked + conditions - 1) / conditions);
    if (seeds < 1) {
      fmt::print("stopped at --limit {}\n", arguments.limit);
      break;
    }
    fmt::print("{}\n", sentence_of(result.comparison, result.verdict, arguments.rule));
    if (!fly_more(arguments, result, seeds)) break;
    result = judged(arguments);
    if (result.comparison.all.goals.pairs() == pairs) break;  // flights that fail to run are no pairs
  }
  return result;
}

int run_judge(const GateArguments& arguments) {
  const Judged result = judge_until_known(arguments);
  const ComparedCampaign& flown = result.candidate;
  GateSides names{arguments.between.empty() ? arguments.baseline : arguments.between[0],
                  arguments.between.empty() ? arguments.candidate : arguments.between[1],
                  fs::path(arguments.page).filename().string(),
                  commands_of(flown.folder, flown.campaign, data_root())};
  const auto write = [](const std::string& file, const std::string& text) {
    if (!file.empty()) write_whole_file(file, text);
  };
  write(arguments.junit, gate_junit(result.comparison, result.verdict));
  write(arguments.json, to_json(result.comparison, result.verdict, arguments.rule, names));
  write(arguments.markdown, to_markdown(result.comparison, result.verdict, arguments.rule, names));
  if (!arguments.page.empty())
    write(arguments.page,
          campaign_page(flown.folder, flown.campaign, gather(flown.folder, flown.campaign), data_root(),
                        GatedCampaign{names, result.comparison, result.verdict,
                                      sentence_of(result.comparison, result.verdict, arguments.rule)}));
  fmt::print("{}", to_report(result.comparison, result.verdict, arguments.rule));
  return status_of(result.verdict);
}

void require(bool is_right, const std::string& message) {
  if (!is_right) throw ScenarioError("gate: " + message);
}

/// The share of pairs whose outcome differs: measured on two campaigns, or of one as if a change drew all
/// outcomes anew.
int run_plan(const GateArguments& arguments) {
  const ComparedCampaign baseline = read_compared(arguments.baseline);
  const auto conditions = static_cast<int>(baseline.campaign.conditions.size());
  double discordance = 0;
  std::string source;
  if (arguments.candidate.empty()) {
    for (const ConditionSummary& condition : summarise(baseline.rows)) {
      const double rate = condition.flown > 0 ? static_cast<double>(condition.goals) / condition.flown : 0.5;
      discordance += 2 * rate * (1 - rate) / conditions;
    }
    source = "as if the change drew every outcome anew; --candidate shows what one did";
  } else {
    const PairedOutcomes goals =
        compare_campaigns(baseline.rows, read_compared(arguments.candidate).rows).all.goals;
    discordance = static_cast<double>(goals.only_first + goals.only_second + 1) / (goals.pairs() + 1);
    source = fmt::format("{} of {} pairs, counted as one more of both", goals.only_first + goals.only_second,
                         goals.pairs());
  }
  const int pairs = planned_pairs(discordance, arguments.power, arguments.rule);
  require(pairs > 0,
          fmt::format("plan: at a discordance of {:.1f} % no 20,000 pairs rule out a fall by {}; choose a "
                      "larger --margin",
                      100 * discordance, arguments.rule.margin));
  const int seeds = (pairs + conditions - 1) / conditions;
  double wall_s = 0;
  const Collected collected = gather(baseline.folder, baseline.campaign);
  for (const FlightCost& cost : collected.costs) wall_s += cost.wall_s;
  const double each_s = collected.costs.empty() ? 0 : wall_s / static_cast<double>(collected.costs.size());
  fmt::print(
      "The outcomes of {:.1f} % of the pairs differ: {}.\n"
      "A change that keeps the rate of success is called not worse (margin {:.3g}) within {} pairs "
      "with probability {:.3g}, if it is looked at after every ten (--extend): {} seeds in each of {} "
      "conditions.\n"
      "The flights of one side then take about {:.0f} min on this machine ({:.1f} s each, {} at a time).\n",
      100 * discordance, source, arguments.rule.margin, pairs, arguments.power, seeds, conditions,
      seeds * conditions * each_s / jobs_or_cores(0) / 60, each_s, jobs_or_cores(0));
  return exit_goal;
}

int run_history(const GateArguments& arguments) {
  const GateHistory history = history_of(arguments.history, arguments.rule);
  if (!arguments.page.empty()) write_whole_file(arguments.page, history_page(history, data_root()));
  fmt::print("{}", history_text(history));
  return exit_goal;
}

int run_gate(GateArguments arguments) {
  arguments.rule = rule_of(arguments.rule, arguments.tolerances);
  const std::vector<std::string> outputs{arguments.junit, arguments.json, arguments.markdown, arguments.page};
  std::vector<std::string> folders = arguments.history;
  for (const std::string& folder : {arguments.baseline, arguments.candidate})
    if (!folder.empty()) folders.push_back(folder);
  for (const std::string& output : outputs) {
    for (const std::string& folder : folders) require_outside(output, folder);
    require_writable(output);
  }
  require_separate({outputs.begin(), outputs.end()}, {});
  if (!arguments.history.empty()) {
    require(arguments.baseline.empty() && arguments.candidate.empty() && arguments.task.empty(),
            "--history looks at folders of its own: no plan, --baseline or --candidate beside it");
    return run_history(arguments);
  }
  require(arguments.task.empty() || arguments.task == "plan",
          arguments.task + ": expected plan; folders are given by --baseline and --candidate");
  if (!arguments.task.empty()) {
    require(!arguments.baseline.empty(), "plan requires --baseline FOLDER, a campaign to learn from");
    return run_plan(arguments);
  }
  require(!arguments.candidate.empty(),
          "requires --candidate FOLDER, the results folder of the campaign with the change");
  require(arguments.between.size() <= 2, "--between is given twice");
  require(
      arguments.between.empty() != arguments.baseline.empty(),
      "requires either --baseline FOLDER, the campaign before the change, or --between A B, two conditions "
      "of the candidate's campaign");
  return run_judge(arguments);
}

}  // namespace

int status_of(const GateVerdict& verdict) {
  if (verdict.passes()) return exit_goal;
  return verdict.verdict == Verdict::undecided ? exit_undecided : exit_not_goal;
}

void add_gate_command(CommandLine& line) {
  const auto arguments = std::make_shared<GateArguments>();
  Command& command =
      line.add({"gate", "compare two campaigns flight by flight and say whether a change may pass",
                "understory gate --baseline results/before --candidate results/after",
                "not worse, or unchanged on these flights",
                "worse, or flights are missing or could not be flown", "not enough flights for a verdict"});
  command.text(
      "task", "plan", arguments->task,
      "plan: say how many flights a verdict needs, from the campaigns given, and how long they take");
  command.text("--baseline", "FOLDER", arguments->baseline,
               "results folder of the campaign before the change");
  command.text("--candidate", "FOLDER", arguments->candidate,
               "results folder of the campaign with the change");
  command.texts("--between", "CONDITION", arguments->between,
                "compare two conditions of the candidate's campaign, the first as the baseline", 2);
  add_rule_options(command, arguments->rule, arguments->tolerances);
  command.number("--power", arguments->power, 0.5, 0.99,
                 "for plan: probability of a verdict within the number of flights that it names");
  const auto extend = command.flag("--extend", arguments->extend,
                                   "fly more seeds of both campaigns until there is a verdict");
  command
      .text("--baseline-program", "FILE", arguments->baseline_program,
            "with --extend: the program that flew the baseline (default: this one, if it did; else the "
            "commands are printed)")
      .needs(extend);
  command.whole("--limit", arguments->limit, 1, 200'000, "with --extend: fly no more than N pairs in all")
      .needs(extend);
  command.texts(
      "--history", "FOLDER", arguments->history,
      "in place of --baseline and --candidate: campaigns to compare, each with the one before it; a folder "
      "stands for the campaigns in it, by name; repeatable");
  command.text("--junit", "FILE", arguments->junit, "write the comparison as JUnit test cases (XML)");
  command.text("--json", "FILE", arguments->json, "write verdict, counts and figures as JSON");
  command.text("--markdown", "FILE", arguments->markdown, "write a comment on the change (Markdown)");
  command.text("--page", "FILE", arguments->page,
               "write the candidate's page with verdict and replays (HTML); with --history a page of curves");
  command.runs([arguments] { return run_gate(*arguments); });
}

}  // namespace understory
