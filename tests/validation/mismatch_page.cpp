#include "tests/validation/mismatch_page.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scenarios/scenario/scenario_io.hpp"
#include "sim/aircraft/aerodynamics.hpp"
#include "tests/validation/mismatch_sections.hpp"

namespace understory {
namespace {

constexpr Seeds seeds{1000, 10};  // of development: settings may have been chosen on them

std::vector<OtherFilter> other_filters(const std::filesystem::path& forest, const FilterConfig& flown) {
  std::vector<OtherFilter> others{{"and angle of attack", flown}, {"no sideslip", flown}};
  others.front().filter.angle_of_attack.enabled = true;
  others.back().filter.sideslip.model = SideslipModel::off;
  others.push_back({"preset windy", load_scenario(forest, {"estimation.preset=windy"}).estimation.filter});
  return others;
}

/// Speeds of level flight by the flat-plate model, at angles of attack that the stack's follower allows.
AxisRange level_speeds(const Scenario& scenario) {
  AxisRange range{HUGE_VAL, -HUGE_VAL};
  const double maximum_rad = scenario.autopilot.autopilot.flight_model.maximum_angle_of_attack_rad;
  for (double speed_mps = 5; speed_mps < 18; speed_mps += 0.05)
    if (straight_trim(scenario.flown_airframe(), speed_mps, 0, maximum_rad))
      range = {std::min(range.minimum, speed_mps), speed_mps};
  return range;
}

std::vector<FlownCondition> fly_all(Scenario scenario, const std::vector<OtherFilter>& others,
                                    const std::filesystem::path& models_folder) {
  std::vector<FilterConfig> filters;
  for (const OtherFilter& other : others) filters.push_back(other.filter);
  std::vector<FlownCondition> all;
  for (const MismatchCondition& condition : mismatch_conditions()) {
    scenario.mismatch = condition.mismatch;
    all.push_back({condition, fly_seeds(scenario, filters, seeds, models_folder), level_speeds(scenario)});
  }
  return all;
}

}  // namespace

ValidationPage mismatch_page(const std::filesystem::path& root) {
  const std::filesystem::path forest = root / "scenarios" / "library" / "forest.yaml";
  const Scenario scenario = load_scenario(forest);
  const std::vector<OtherFilter> others = other_filters(forest, scenario.estimation.filter);
  const std::vector<FlownCondition> all = fly_all(scenario, others, root / "models");
  ValidationPage page;
  page.file = "model_mismatch";
  page.title = "An aircraft that is not the model's";
  page.introduction = fmt::format(
      "The stack plans, follows and estimates with one airframe, and another one flies: the scenario's "
      "`mismatch` changes the simulator's mass (with its inertia), lift, drag, rate damping or input delay "
      "by percentages, and the stack is not told. \"{0}\" is heavier, with more drag, less lift and less "
      "damping by that much each, and a delay longer by five times as many percent.\n\nEach aircraft flies "
      "scenarios/library/forest.yaml with the development seeds {1} to {2}, in calm air, on true depth (what "
      "cameras cost is told elsewhere) and on the default filter with its own sensors. `./run validate "
      "--only "
      "mismatch` writes this page, and ends with status 1 where a tolerance is broken.\n",
      adverse_name, seeds.first, seeds.first + seeds.count - 1);
  page.sections = {mismatch_success_section(all), mismatch_drift_section(all, others)};
  return page;
}

}  // namespace understory
