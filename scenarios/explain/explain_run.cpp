#include "scenarios/explain/explain_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/campaign/engines.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/flight_logger.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/flight/ideal_parts.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/signals.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr double beyond_the_end_s = 2;  ///< who still flies then has survived

/// Keeps what the detector found, frame by frame.
class HitKeeper : public FlightObserver {
 public:
  void on_frame(const Flight& flight) override { known_[flight.frame().t_ns] = flight.hits(); }
  const KnownHits& known() const { return known_; }

 private:
  KnownHits known_;
};

/// The lost flight's scenario until the moment, then with ideal parts and other noise.
Scenario redrawn(const Scenario& scenario, double end_s, const Redraw& redraw, const fs::path& hits) {
  Scenario one = scenario;
  one.ideal = {redraw.parts, end_s - redraw.before_end_s, redraw.seed, hits.string()};
  one.time_limit_s = std::min(scenario.time_limit_s, end_s + beyond_the_end_s);
  return one;
}

std::string name_of(const Redraw& redraw) {
  const std::string parts = fmt::format("{}", fmt::join(redraw.parts, "_"));
  return fmt::format("{}-{:.2f}s-{}", parts.empty() ? the_control : parts, redraw.before_end_s, redraw.seed);
}

}  // namespace

ExplainedFlight explain_flight(const Scenario& scenario, const ExplainOptions& options) {
  if (scenario.ideal.acts())
    throw ScenarioError(
        fmt::format("{}: has ideal parts already; explain the flight without them", scenario.name));
  FlightLogger logger;
  HitKeeper keeper;
  FlyOptions once;
  once.models_folder = options.models_folder;
  once.renderer = options.renderer;
  once.logger = &logger;
  once.observers = {&keeper};
  const FlightResult result = fly(scenario, once);
  if (result.outcome == Outcome::goal || result.outcome == Outcome::time)
    throw ScenarioError(fmt::format("{}, seed {}: ended by {}; only a flight that crashed is explained",
                                    scenario.name, scenario.seed, word_for(result.outcome)));
  std::error_code ignored;
  fs::remove_all(options.work_folder, ignored);  // a program that was killed left its flights
  const CampaignFolder folder{options.work_folder};
  for (const char* part : {"conditions", "flights", "logs"}) prepare_output_folder(folder.path / part);
  const fs::path hits = fs::absolute(folder.path / "hits");
  write_whole_file(hits, to_bytes(keeper.known()));
  const double end_s = result.simulated_s;
  std::size_t flown = 0;
  const auto fly_redraws = [&](std::vector<Redraw>& asked) {
    Campaign campaign;
    campaign.renderer = std::string(word_for(options.renderer));
    campaign.seeds = {scenario.seed};
    for (const Redraw& redraw : asked) {
      const std::string name = fmt::format("{}-{}", flown + campaign.conditions.size(), name_of(redraw));
      campaign.conditions.push_back(
          {name, scenario_to_text(redrawn(scenario, end_s, redraw, hits)), scenario.name, name, {}});
      write_whole_file(folder.condition_file(campaign.conditions.back()),
                       campaign.conditions.back().scenario_text);
    }
    const std::vector<CampaignTask> tasks = tasks_of(campaign);
    const auto tell = [&](const CampaignProgress& progress) {
      if (options.on_progress) options.on_progress(flown + progress.over);
    };
    if (!fly_locally(folder, campaign, tasks, {options.jobs, false}, tell)) throw Stopped{};
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const FlightRow row = read_flight(folder, tasks[i]).value_or(FlightFile{}).row;
      if (!row.flown()) throw MachineError(fmt::format("{}: {}", tasks[i].id, row.reason));
      asked[i].survived = row.reached_goal() || row.outcome == word_for(Outcome::time);
    }
    flown += asked.size();
  };
  const double launch_s = logger.log().launch_ns ? seconds(*logger.log().launch_ns) : 0;
  ToldExplanation told;
  const auto shown = [&](double last_chance_s) {
    std::vector<std::string> parts;
    told.evidence = evidence_in(logger.log(), last_chance_s);
    for (const Evidence& one : told.evidence)
      if (one.is_there) parts.push_back(one.part);
    return parts;
  };
  const ExplanationOptions inquiry{moments_of(end_s - launch_s), options.flights,
                                   static_cast<std::uint64_t>(options.first_seed), shown};
  told.explanation = explain(inquiry, fly_redraws);
  told.conclusion = conclusion_of(told.explanation, told.evidence);
  return {logger.log(), told};
}

}  // namespace understory
