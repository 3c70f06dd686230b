#include <algorithm>
#include <cmath>

#include "scenarios/recording/carry.hpp"
#include "scenarios/recording/record.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {

RecordedWalk walk_recorded(const Scenario& scenario, const WalkConfig& config, const FlyOptions& options) {
  Carriage carriage;
  carriage.rig = rig_of(scenario, options.models_folder);
  carriage.obstacles = course_obstacles(scenario);
  const WalkPath path = walk_path(config, scenario, carriage.rig.rig, carriage.obstacles);
  carriage.truth_at = [&](std::int64_t t_ns) { return walk_truth(path, t_ns); };
  const double way_s = (scenario.goal_x_m() - path.from_x_m) / config.speed_mps;
  carriage.end_ns = std::llround(std::min(way_s, scenario.time_limit_s) * 1e9);
  return {path, carry_recorded(scenario, carriage, options)};
}

}  // namespace understory
