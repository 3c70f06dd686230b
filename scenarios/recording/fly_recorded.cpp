#include <algorithm>

#include "scenarios/recording/euroc_recording.hpp"
#include "scenarios/recording/record.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

/// Long enough for any flight that gets there: dodging included, none is slower.
double longest_flight_s(const Scenario& scenario) {
  constexpr double slow_mps = 8;
  return std::min(scenario.time_limit_s, scenario.launch.rest_s + 1 + scenario.goal_x_m() / slow_mps);
}

}  // namespace

RecordedFlight fly_recorded(const Scenario& scenario, FlyOptions options) {
  EurocRecording recording(options.output_folder, scenario, rig_of(scenario, options.models_folder),
                           longest_flight_s(scenario));
  options.on_truth = [&](const Truth& truth) { recording.observe(truth); };
  options.on_imu = [&](const ImuSample& sample) { recording.add(sample); };
  options.on_estimate = [&](const State& state) { recording.add_estimate(state); };
  options.on_frame = [&](const StereoFrame& frame, StereoCameras& cameras) { recording.add(frame, cameras); };
  const FlightResult result = fly(scenario, options);
  recording.finish();
  return {result, recording.frames()};
}

}  // namespace understory
