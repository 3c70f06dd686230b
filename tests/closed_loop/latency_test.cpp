#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "perception/io/calibration/calibration_file.hpp"
#include "planning/autopilot.hpp"
#include "scenarios/config/named_seed.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/onboard_sensors.hpp"
#include "scenarios/parts/oracles.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "sim/aircraft/aircraft.hpp"
#include "sim/sensors/sensors.hpp"

/// From an image that shows something new to elevons that move: at most 50 ms.
namespace understory {
namespace {

constexpr std::int64_t maximum_latency_ns = 50'000'000;
constexpr std::int64_t never_ns = std::int64_t{1} << 60;

/// Perfect vision that opens its eyes with the first image exposed at `opens_ns`.
class OpeningEyes : public ObstacleDetector {
 public:
  OpeningEyes(const StereoRig& rig, const std::vector<Obstacle>& obstacles, const TruthHistory& history,
              std::int64_t opens_ns)
      : eyes_(rig, obstacles, history), opens_ns_(opens_ns) {}
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override {
    return frame.t_ns < opens_ns_ ? nothing_ : eyes_.detect(frame);
  }

 private:
  TrueDepth eyes_;
  const std::vector<StereoHit> nothing_;
  std::int64_t opens_ns_;
};

Scenario library_scenario(const std::string& name) {
  return load_scenario(UNDERSTORY_SOURCE_DIR "/scenarios/library/" + name + ".yaml");
}

struct Loop {
  Scenario scenario;
  StereoRig rig = read_rig(UNDERSTORY_SOURCE_DIR "/models/rigs/" + scenario.rig + ".yaml");
  World world = build_world(UNDERSTORY_SOURCE_DIR "/models", scenario.airframe, {}, scenario.world_config());

  /// The surfaces at every physics step up to `end_ns`, by the loop of scenarios/flight at the scenario's
  /// rates, among `obstacles` that are visible from `opens_ns` on and cannot be touched.
  std::vector<double> left_elevon(const std::vector<Obstacle>& obstacles, std::int64_t opens_ns,
                                  std::int64_t end_ns) {
    Aircraft aircraft(*world.model, scenario.airframe, scenario.launch, scenario.wind_world_mps);
    TruthHistory history;
    OpeningEyes eyes(rig, obstacles, history, opens_ns);
    TrueState state_source(history);
    const std::unique_ptr<Planner> planner = planner_of(scenario);
    Autopilot autopilot(scenario.autopilot, scenario.airframe, rig, eyes, state_source, *planner);
    Imu imu(scenario.sensors.imu, seed_for(1000, "imu"));
    const auto latency_ns = static_cast<std::int64_t>(scenario.cameras.latency_s * 1e9);
    std::deque<StereoFrame> pending;
    Controls controls;
    std::vector<double> surfaces;
    for (FlightClock clock(scenario); clock.t_ns() < end_ns; clock.advance()) {
      const Truth& truth = aircraft.truth();
      history.observe(truth);
      surfaces.push_back(truth.left_elevon_rad);
      if (clock.imu()) autopilot.on(imu.measure(truth));
      if (clock.camera()) pending.push_back({truth.t_ns, {}, {}});
      while (!pending.empty() && truth.t_ns >= pending.front().t_ns + latency_ns) {
        autopilot.on(pending.front());
        pending.pop_front();
      }
      if (clock.replan()) autopilot.replan(truth.t_ns);
      if (clock.imu()) controls = autopilot.controls(truth.t_ns);
      aircraft.step(controls);
    }
    return surfaces;
  }
};

TEST(Latency, TheConfiguredDelaysAddUpToLessThanTheLimit) {
  for (const char* name : {"forest", "dense", "paper", "goalposts"}) {
    const Scenario scenario = library_scenario(name);
    const double control_period_s = 1.0 / scenario.sensors.imu_rate_hz;
    EXPECT_LE(scenario.cameras.latency_s + scenario.autopilot.plan_latency_s + control_period_s +
                  scenario.airframe.input_delay_s,
              0.050)
        << name;
  }
}

/// With the autopilot of that scenario.
class LatencyOf : public testing::TestWithParam<const char*> {};

TEST_P(LatencyOf, ElevonsAnswerAnImageWithinTheLimit) {
  Loop loop{library_scenario(GetParam())};
  // At 1.7 s the aircraft is some 13 m out, in level flight. A row of trunks crosses its way at the depth
  // that the rig sees, so that whenever the eyes open there is something to avoid, off centre so that one
  // side is better.
  const std::int64_t first_ns = time_of_step_ns(2040), frame_ns = time_of_step_ns(physics_rate_hz / 120);
  std::int64_t slowest_ns = 0;
  for (int frame = 0; frame < 8; ++frame) {
    const std::int64_t opens_ns = first_ns + frame * frame_ns;
    std::vector<Obstacle> obstacles;
    for (int i = 0; i < 6; ++i) {
      Obstacle trunk;
      trunk.name = "trunk";
      trunk.from_world = {20.0 + i, 0.1 - 0.2 * i, 0};
      trunk.to_world = {20.0 + i, 0.1 - 0.2 * i, 9};
      obstacles.push_back(trunk);
    }
    const std::int64_t end_ns = opens_ns + 4 * maximum_latency_ns;
    const std::vector<double> seeing = loop.left_elevon(obstacles, opens_ns, end_ns);
    const std::vector<double> unseeing = loop.left_elevon(obstacles, never_ns, end_ns);
    const auto [first, other] = std::mismatch(seeing.begin(), seeing.end(), unseeing.begin());
    ASSERT_NE(first, seeing.end()) << "never answered";
    const std::int64_t moved_ns = time_of_step_ns(first - seeing.begin());
    EXPECT_GT(moved_ns, opens_ns + 8'000'000) << "answered before the image arrived";
    EXPECT_LE(moved_ns - opens_ns, maximum_latency_ns);
    slowest_ns = std::max(slowest_ns, moved_ns - opens_ns);
  }
  RecordProperty("slowest_us", static_cast<int>(slowest_ns / 1000));
}

// One plans after every pair of images, the other when something new is seen and seldom otherwise.
INSTANTIATE_TEST_SUITE_P(Scenarios, LatencyOf, testing::Values("clear", "forest"));

}  // namespace
}  // namespace understory
