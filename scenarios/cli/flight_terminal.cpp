#include "scenarios/cli/flight_terminal.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scenarios/cli/commands.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "sim/render/offscreen_context.hpp"

namespace understory {

void show(ProgressLine& line, const FlightProgress& progress) {
  const std::string clearance =
      std::isfinite(progress.min_clearance_m) ? fmt::format("{:.2f} m", progress.min_clearance_m) : "-";
  line.show(
      fmt::format("{:5.2f} s  {:5.1f} of {:.0f} m  {:4.1f} m/s  minimum clearance {}  {:.2f} x real time",
                  progress.simulated_s, progress.progress_m, progress.goal_m, progress.speed_mps, clearance,
                  progress.wall_s > 0 ? progress.simulated_s / progress.wall_s : 0.0));
}

std::string renderer_of_this_machine() {
  try {
    OffscreenContext context;
    context.make_current(16, 16);
    return context.renderer();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

void require_rig(const Scenario& scenario, const ScenarioArguments& arguments,
                 const std::filesystem::path& rigs) {
  std::error_code ignored;
  if (std::filesystem::exists(rigs / (scenario.rig + ".yaml"), ignored)) return;
  if (std::filesystem::is_regular_file(scenario.rig, ignored)) return;
  throw ScenarioError(fmt::format(
      "{}: rig: expected a name in {} or a rig file, got '{}'",
      where_given(scenario_file(arguments.scenario), arguments.all_settings(), "rig", arguments.with_files()),
      rigs.string(), scenario.rig));
}

}  // namespace understory
