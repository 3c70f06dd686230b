#include <cmath>

#include "scenarios/recording/carried_truth.hpp"
#include "scenarios/recording/carry.hpp"
#include "scenarios/recording/path_file.hpp"
#include "scenarios/recording/record.hpp"
#include "scenarios/recording/smooth_path.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {

Carried follow_recorded(const Scenario& scenario, const std::vector<TimedPose>& poses,
                        const FlyOptions& options) {
  const SmoothPath path(thinned(poses));
  Carriage carriage;
  carriage.rig = rig_of(scenario, options.models_folder);
  carriage.obstacles = course_obstacles(scenario);
  carriage.truth_at = [&](std::int64_t t_ns) {
    return carried_truth([&](double t_s) { return path.at(t_s); }, t_ns, scenario.airframe.gravity_mps2);
  };
  carriage.end_ns = std::llround(path.length_s() * 1e9) + 1;  // the last pose, too
  return carry_recorded(scenario, carriage, options);
}

}  // namespace understory
