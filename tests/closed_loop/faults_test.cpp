#include <gtest/gtest.h>

#include <cmath>

#include "perception/io/calibration/calibration_file.hpp"
#include "planning/autopilot.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/onboard_sensors.hpp"
#include "scenarios/parts/oracles.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "tests/closed_loop/flown.hpp"

/// What sensors and cameras that are not ideal, and their faults, do to a flight.
namespace understory {
namespace {

const std::vector<std::string> blind_and_short{"perception.detector=none", "cameras.rate_hz=1",
                                               "forest.length_m=20"};

/// Writes down what arrives, and when by the IMU's clock.
class Listener : public StateSource {
 public:
  void on(const Sample& sample) override {
    if (const auto* imu = std::get_if<ImuSample>(&sample)) now_ns = imu->t_ns;
    if (std::holds_alternative<BarometerSample>(sample)) ++altitudes;
    const auto* fix = std::get_if<GpsSample>(&sample);
    if (fix == nullptr) return;
    fixes.push_back(*fix);
    ages_ns.push_back(now_ns - fix->t_ns);
  }
  const State& state() const override { return state_; }
  State state_at(std::int64_t) const override { return state_; }

  std::int64_t now_ns = 0;
  int altitudes = 0;
  std::vector<GpsSample> fixes;
  std::vector<std::int64_t> ages_ns;

 private:
  State state_;
};

/// Two seconds on a straight line at 10 m/s.
Listener heard(const std::vector<std::string>& settings) {
  const Scenario scenario = load_scenario(UNDERSTORY_SOURCE_DIR "/scenarios/library/clear.yaml", settings);
  const StereoRig rig = read_rig(UNDERSTORY_SOURCE_DIR "/models/rigs/" + scenario.rig + ".yaml");
  Listener listener;
  NoDetector detector;
  const std::unique_ptr<Planner> planner = planner_of(scenario);
  Autopilot autopilot(scenario.autopilot, scenario.airframe, rig, detector, listener, *planner);
  OnboardSensors sensors(scenario);
  for (FlightClock clock(scenario); clock.step() <= 2 * physics_rate_hz; clock.advance()) {
    Truth truth;
    truth.t_ns = clock.t_ns();
    truth.T_world_body.translation().x() = 10 * 1e-9 * static_cast<double>(truth.t_ns);
    sensors.deliver(clock, truth, autopilot);
  }
  return listener;
}

TEST(OnboardSensors, FixesComeLateAndOnlyWhereEnabled) {
  EXPECT_TRUE(heard({}).fixes.empty());
  const Listener listener = heard({"sensors.grade=ideal", "sensors.gps.enabled=true"});
  ASSERT_EQ(listener.fixes.size(), 10u);  // of 0, 0.2 ... 1.8 s; that of 2.0 s is under way
  for (std::size_t i = 0; i < listener.fixes.size(); ++i) {
    EXPECT_EQ(listener.fixes[i].t_ns, static_cast<std::int64_t>(i) * 200'000'000);
    EXPECT_EQ(listener.ages_ns[i], 200'000'000);
    EXPECT_NEAR(listener.fixes[i].position_world_m.x(), 2.0 * static_cast<double>(i), 1e-9);  // as it was
  }
}

TEST(OnboardSensors, ADropoutSilencesOneSensor) {
  const Listener whole = heard({"sensors.gps.enabled=true"});
  const Listener broken = heard({"sensors.gps.enabled=true",
                                 "faults=[{sensor: barometer, kind: dropout, at_s: 1, duration_s: 0.5}, "
                                 "{sensor: gps, kind: dropout, at_s: 1, duration_s: 0.5}]"});
  EXPECT_EQ(whole.altitudes, 101);
  EXPECT_EQ(broken.altitudes, 76);
  EXPECT_EQ(broken.fixes.size(), whole.fixes.size() - 3);  // of 1.0, 1.2 and 1.4 s
  // The other samples are unchanged: a fault does not reach the sensors.
  EXPECT_EQ(broken.fixes.back().position_world_m, whole.fixes.back().position_world_m);
}

TEST(SensorFaults, OneAfterTheFlightChangesNothing) {
  const std::vector<std::string> later =
      with(blind_and_short,
           {"faults=[{sensor: pitot, kind: block, at_s: 500}, {sensor: camera, kind: dropout, at_s: 500}]"});
  EXPECT_EQ(flown("clear", 1000, blind_and_short).digest(), flown("clear", 1000, later).digest());
}

TEST(SensorFaults, WithoutFramesNothingIsSeen) {
  const Flown flight =
      flown("forest", 1000, {"forest.length_m=20", "faults=[{sensor: camera, kind: dropout}]"});
  EXPECT_EQ(flight.detections(), 0);
  EXPECT_EQ(flight.remembered_points(), 0);
}

TEST(SensorFaults, AGyroBiasTurnsTheEstimate) {
  const auto worst_m = [](const std::vector<std::string>& faults) {
    const Flown flight = flown("clear", 1000, with(blind_and_short, faults));
    return flight.result.at("position_error_max_m").get<double>();
  };
  EXPECT_GT(worst_m({"faults=[{sensor: gyro, kind: bias, at_s: 1, value: 0.2}]"}), 2 * worst_m({}));
}

const std::vector<std::string> short_forest{"forest.length_m=20", "forest.square_metres_per_tree=25"};

TEST(CameraFaultsInFlight, RawCamerasAreRectifiedByTheStackAndShowItTheSameTrees) {
  const Flown ideal = flown("forest", 1000, short_forest);
  const Flown raw = flown("forest", 1000, with(short_forest, {"cameras.raw=true"}));
  EXPECT_EQ(raw.outcome(), "goal");
  // Two interpolations soften the bark's edges, so fewer blocks pass, but most trees are still seen.
  EXPECT_GT(3 * raw.detections(), ideal.detections());
  EXPECT_GT(ideal.detections(), raw.detections());
  EXPECT_EQ(raw.digest(), flown("forest", 1000, with(short_forest, {"cameras.raw=true"})).digest());
}

TEST(CameraFaultsInFlight, DroppedFramesNeverArriveAndTheOthersDo) {
  // 0.9 s on the rail and after it: 108 exposures, of which half are dropped.
  const std::vector<std::string> brief{"forest.length_m=20", "time_limit_s=0.9"};
  const auto frames = [&](const char* probability) {
    return flown("clear", 1000, with(brief, {std::string("cameras.drop_probability=") + probability}))
        .result.at("frames")
        .get<double>();
  };
  const double all = frames("0");
  EXPECT_GT(all, 100);
  EXPECT_NEAR(frames("0.5"), 0.5 * all, 4 * std::sqrt(0.25 * all));
  EXPECT_EQ(frames("1"), 0);
}

TEST(CameraFaultsInFlight, WhatIsOffChangesNothingAndWhatIsOnRepeats) {
  // Settings that only matter together with others that are off.
  const Flown plain = flown("forest", 1000, short_forest);
  EXPECT_EQ(flown("forest", 1000, with(short_forest, {"cameras.exposure_views=9"})).digest(), plain.digest());
  const std::vector<std::string> everything =
      with(short_forest, {"cameras.exposure_s=0.003", "cameras.exposure_views=2",
                          "cameras.right_delay_s=0.001", "cameras.full_well_e=10000", "cameras.light=0.5",
                          "cameras.gain=2", "cameras.vignetting_power=4", "cameras.drop_probability=0.05",
                          "cameras.vertical_misalignment_px=0.3", "cameras.flex_position_m=[0.001,0,0]"});
  const Flown one = flown("forest", 1000, everything), other = flown("forest", 1000, everything);
  EXPECT_EQ(one.digest(), other.digest());
  EXPECT_NE(one.digest(), plain.digest());
  EXPECT_GT(one.detections(), 0);
}

}  // namespace
}  // namespace understory
