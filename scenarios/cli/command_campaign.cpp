#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <set>

#include "scenarios/campaign/campaign_file.hpp"
#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/campaign/data_set.hpp"
#include "scenarios/campaign/engines.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/explain/explain_run.hpp"
#include "scenarios/flight/flight_identity.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/folder_mark.hpp"
#include "scenarios/output/progress_line.hpp"
#include "scenarios/output/signals.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

enum class Engine { local, slurm };
constexpr std::array<std::pair<std::string_view, Engine>, 2> engine_names{
    {{"local", Engine::local}, {"slurm", Engine::slurm}}};

struct CampaignArguments {
  std::string file;
  std::vector<std::string> with, settings, seeds;
  std::string out;    // empty: results/<name>
  std::string junit;  // empty: none
  Engine engine = Engine::local;
  RendererKind renderer = RendererKind::osmesa;
  SlurmConfig slurm;
  int jobs = 0;  // 0: a flight a core
  bool no_wait = false;
  bool resume = false;
  bool print_tasks = false;
  bool keeps_runs = false;
  bool explains = false;
  RecordingChoice recording;
};

/// Of every condition, before anything is flown: a rig that is not there would fail every flight.
std::vector<Scenario> scenarios_of(const Campaign& campaign, const std::string& file) {
  std::vector<Scenario> scenarios;
  for (const Condition& condition : campaign.conditions) {
    try {
      scenarios.push_back(scenario_from_text(condition.scenario_text, condition.name));
      rig_of(scenarios.back(), data_root() / "models");
    } catch (const ScenarioError& error) {
      throw ScenarioError(fmt::format("{}: condition {}: {}", file, condition.name, error.what()));
    }
  }
  return scenarios;
}

void show(ProgressLine& line, const CampaignProgress& progress) {
  const std::string not_flown =
      progress.not_flown > 0 ? fmt::format(", {} not flown", progress.not_flown) : "";
  line.show(fmt::format("{} of {} flights, {} at the goal{}", progress.over, progress.flights, progress.goals,
                        not_flown),
            progress.over - progress.before, progress.flights - progress.over);
}

int print_tasks(const CampaignFolder& folder, const Campaign& campaign) {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  for (const CampaignTask& task : tasks_of(campaign)) {
    if (const auto file = read_flight(folder, task); file && file->row.flown()) continue;
    std::string line = quoted(program.string());
    for (const std::string& argument : flight_arguments(folder, campaign, task, false))
      line += fmt::format(" {}", quoted(argument));
    fmt::print("{}\n", line);
  }
  return 0;
}

/// How a campaign ends: every flight over, or stopped by a signal.
enum class Finish { all_over, stopped };

Finish fly_here(const CampaignFolder& folder, const Campaign& campaign, const CampaignArguments& arguments) {
  LocalEngineConfig config;
  config.jobs = jobs_or_cores(arguments.jobs);
  config.keeps_runs = arguments.keeps_runs;
  ProgressLine line;
  const bool finished = fly_locally(folder, campaign, in_flying_order(campaign), config,
                                    [&](const CampaignProgress& progress) { show(line, progress); });
  return finished ? Finish::all_over : Finish::stopped;
}

Finish fly_on_slurm(const CampaignFolder& folder, const Campaign& campaign,
                    const CampaignArguments& arguments) {
  const std::string job = submit_to_slurm(folder, campaign, arguments.slurm);
  fmt::print("Slurm job {}: {} shards\n", job, arguments.slurm.shards);
  std::fflush(stdout);
  if (arguments.no_wait) return Finish::stopped;
  ProgressLine line;
  const bool finished =
      wait_for_slurm(folder, campaign, job, [&](const CampaignProgress& progress) { show(line, progress); });
  return finished ? Finish::all_over : Finish::stopped;
}

/// An option of the other engine would do nothing.
void require_engine(const CampaignArguments& arguments) {
  const bool on_slurm = arguments.engine == Engine::slurm;
  const auto refuse = [](bool is_given, const char* option, const char* engine) {
    if (is_given) throw ScenarioError(fmt::format("{}: needs --engine {}", option, engine));
  };
  refuse(!on_slurm && !arguments.slurm.options.empty(), "--sbatch", "slurm");
  refuse(!on_slurm && arguments.no_wait, "--no-wait", "slurm");
  refuse(!on_slurm && arguments.slurm.shards != SlurmConfig().shards, "--shards", "slurm");
  refuse(on_slurm && arguments.jobs != 0, "--jobs", "local");
  refuse(on_slurm && arguments.keeps_runs, "--keep-runs", "local");
  refuse(on_slurm && arguments.explains, "--explain", "local");
}

/// Of a campaign file, or of the folder of a campaign that is to go on.
Campaign campaign_of(const CampaignArguments& arguments, const std::vector<ConfigNode>& over) {
  if (holds_campaign(arguments.file)) {
    if (!over.empty())
      throw ScenarioError(fmt::format(
          "{}: --set and --with change a campaign file, not a campaign that has begun", arguments.file));
    return read_campaign({arguments.file});
  }
  ProgressLine line;
  return load_campaign(library_file(arguments.file, "campaigns", "campaign"), scenario_file, over,
                       [&](std::size_t done, std::size_t of) {
                         line.show(fmt::format("{} of {} conditions read", done, of), done, of - done);
                       });
}

int run_campaign(const CampaignArguments& arguments) {
  require_engine(arguments);
  std::vector<ConfigNode> over;
  for (const std::string& file : arguments.with) over.push_back(parse_config_file(file));
  for (const std::string& setting : arguments.settings) over.push_back(parse_assignment(setting));
  Campaign campaign = campaign_of(arguments, over);
  campaign.files.insert(campaign.files.end(), arguments.with.begin(), arguments.with.end());
  if (!arguments.seeds.empty()) {
    if (!holds_campaign(arguments.file)) campaign.seeds.clear();
    std::set<std::uint64_t> known(campaign.seeds.begin(), campaign.seeds.end());
    std::ranges::copy_if(seeds_of(arguments.seeds, "--seeds"), std::back_inserter(campaign.seeds),
                         [&](std::uint64_t seed) { return known.insert(seed).second; });
  }
  const std::vector<Scenario> scenarios = scenarios_of(campaign, arguments.file);
  const CampaignFolder folder{!arguments.out.empty()           ? fs::path(arguments.out)
                              : holds_campaign(arguments.file) ? fs::path(arguments.file)
                                                               : fs::path("results") / campaign.name};
  if (folder.path.string().find('\n') != std::string::npos)  // --print-tasks prints a line for each flight
    throw ScenarioError(fmt::format("{}: the folder's name must not hold line breaks", folder.path.string()));
  require_separate({arguments.junit}, campaign.files);
  require_outside(arguments.junit, folder.path);
  require_writable(arguments.junit);
  FolderMark mark(folder.path, campaign_results, folder.path);
  if (!arguments.recording.form && arguments.recording.every != 1)
    throw ScenarioError("--every requires --record");
  campaign.recording = arguments.recording;
  if (fs::exists(folder.path / campaign_results.manifest)) {  // before anything is opened
    const Campaign held = read_campaign(folder);
    if (!arguments.recording.form) campaign.recording = held.recording;
  }
  const OpenedRenderer renderer = opened_renderer(arguments.renderer);
  campaign.renderer = word_for(renderer.kind);
  campaign.identity = identity_of(scenarios, data_root() / "models", renderer);
  campaign.pictures = pictures_of(scenarios, data_root() / "models", renderer.kind);
  remove_parts(folder);
  prepare_campaign_folder(mark, folder, campaign, arguments.resume, !arguments.seeds.empty());
  if (arguments.print_tasks) return print_tasks(folder, campaign);

  const StopSignals stop_signals;
  const bool on_slurm = arguments.engine == Engine::slurm;
  const Finish finish =
      on_slurm ? fly_on_slurm(folder, campaign, arguments) : fly_here(folder, campaign, arguments);
  const Collected collected = collect(folder, campaign);
  if (finish == Finish::all_over) {
    const int status = report(folder, campaign, collected, arguments.junit);
    if (campaign.recording.form) write_data_set_files(folder, collected.rows, *campaign.recording.form);
    if (arguments.explains)
      explain_campaign(folder.path, arguments.renderer, arguments.jobs, ExplainOptions().flights);
    return status;
  }
  if (on_slurm) {
    const std::string what =
        fmt::format("the job goes on; understory collect {} gathers what it leaves", folder.path.string());
    if (stop_signals.asked()) throw Stopped(stop_signals.number(), what);
    fmt::print("{}\n", what);
    return exit_goal;
  }
  throw Stopped(stop_signals.number(),
                fmt::format("{}: stopped with {} of {} flights over; --resume goes on", folder.path.string(),
                            collected.rows.size(), collected.rows.size() + collected.missing));
}

RendererKind renderer_named(const std::string& word) {
  for (const auto& [name, renderer] : renderer_names)
    if (name == word) return renderer;
  return RendererKind::osmesa;  // read_campaign() lets no other word through
}

struct ShardArguments {
  std::string folder;
  int number = 0;
  int of = 1;
  int jobs = 1;
};

int run_shard(const ShardArguments& arguments) {
  const CampaignFolder folder{arguments.folder};
  const Campaign campaign = read_campaign(folder);
  if (arguments.number >= arguments.of)
    throw ScenarioError(
        fmt::format("--number {}: must be less than --of {}", arguments.number, arguments.of));
  std::vector<Scenario> scenarios;
  for (const Condition& condition : campaign.conditions)
    scenarios.push_back(
        scenario_from_text(condition.scenario_text, folder.condition_file(condition).string()));
  require_identity(
      folder, campaign,
      identity_of(scenarios, data_root() / "models", opened_renderer(renderer_named(campaign.renderer))));
  const StopSignals stop_signals;
  LocalEngineConfig config;
  config.jobs = arguments.jobs;
  const bool finished =
      fly_locally(folder, campaign, tasks_of_shard(campaign, arguments.number, arguments.of), config, {});
  if (!finished) throw Stopped(stop_signals.number(), "stopped; the same command goes on");
  return exit_goal;
}

}  // namespace

void add_campaign_command(CommandLine& line) {
  const auto arguments = std::make_shared<CampaignArguments>();
  Command& command = line.add(
      {"campaign", "fly every seed under every condition of a campaign, each flight in its own process",
       "understory campaign gate --out results/gate", "every flight was flown, whatever its outcome",
       "a flight could not be flown"});
  command
      .text("file", "FILE", arguments->file,
            "campaign file, a name in scenarios/library/campaigns (docs/campaigns.md), or the results folder "
            "of a campaign that is to go on")
      .required();
  command.text("--out", "FOLDER", arguments->out, "results folder (default: results/NAME)");
  add_with_option(command, arguments->with);
  add_settings_option(command, arguments->settings);
  command.texts(
      "--seeds", "SEEDS", arguments->seeds,
      "seeds in place of the file's, for example 1000..1079; more seeds where FILE is a results folder; "
      "repeatable");
  add_jobs_option(command, arguments->jobs, "flights");
  add_renderer_option(command, arguments->renderer);
  command.choice("--engine", arguments->engine, engine_names,
                 "where flights run: on this machine, or as a Slurm job array");
  command.whole("--shards", arguments->slurm.shards, 1, 10000,
                "with slurm: number of tasks in the job array");
  command.texts("--sbatch", "OPTION", arguments->slurm.options,
                "with slurm: an option for sbatch, for example --sbatch=--partition=short; repeatable");
  command.flag("--no-wait", arguments->no_wait, "with slurm: return after the job is submitted");
  command.flag("--resume", arguments->resume, "continue the unfinished campaign in the results folder");
  command.flag(
      "--print-tasks", arguments->print_tasks,
      "print one command per flight instead of flying; after running them, gather the results with collect");
  command.text("--junit", "FILE", arguments->junit, "write each flight as a JUnit test case (XML)");
  command.flag("--explain", arguments->explains,
               "then find out why flights were lost, as explain does (docs/explain.md)");
  add_recording_options(
      command, "--record", arguments->recording,
      "record each flight as a data set in FOLDER/runs, with a list, a licence and checksums "
      "(docs/record.md): euroc, kitti or middlebury");
  command.flag("--keep-runs", arguments->keeps_runs, "keep the run folder of each flight in FOLDER/runs");
  command.runs([arguments] { return run_campaign(*arguments); });
}

void add_shard_command(CommandLine& line) {
  const auto arguments = std::make_shared<ShardArguments>();
  Command& command =
      line.add({"shard", "fly one shard (part) of a campaign; campaign --engine slurm submits such shards",
                "understory shard results/gate --number 0 --of 8", "the flights of the shard were flown"});
  command.text("folder", "FOLDER", arguments->folder, "results folder of the campaign").required();
  command.whole("--number", arguments->number, 0, 9999, "number of the shard, from 0").required();
  command.whole("--of", arguments->of, 1, 10000, "number of shards").required();
  command.whole("--jobs", arguments->jobs, 1, 1024, "number of flights at a time");
  command.runs([arguments] { return run_shard(*arguments); });
}

}  // namespace understory
