#include <gtest/gtest.h>

#include "perception/io/rig_file.hpp"
#include "planning/autopilot.hpp"
#include "scenarios/flight/onboard_sensors.hpp"
#include "scenarios/flight/oracles.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "tests/closed_loop/flown.hpp"

/// What sensors and their faults do to a flight.
namespace understory {
namespace {

const std::vector<std::string> blind_and_short{"perception.detector=none", "cameras.rate_hz=1",
                                               "forest.length_m=20"};

/// Writes down what arrives, and when by the IMU's clock.
class Listener : public StateSource {
 public:
  void on(const ImuSample& sample) override { now_ns = sample.t_ns; }
  void on(const PitotSample&) override {}
  void on(const BarometerSample&) override { ++altitudes; }
  void on(const MagnetometerSample&) override {}
  void on(const ResightingSample&) override {}
  void on(const GpsSample& fix) override {
    fixes.push_back(fix);
    ages_ns.push_back(now_ns - fix.t_ns);
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
  Autopilot autopilot(scenario.autopilot.autopilot, scenario.airframe, rig, scenario.mission(), detector,
                      listener, 1);
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
    return flight.result.at("estimation").at("position_error_max_m").get<double>();
  };
  EXPECT_GT(worst_m({"faults=[{sensor: gyro, kind: bias, at_s: 1, value: 0.2}]"}), 2 * worst_m({}));
}

}  // namespace
}  // namespace understory
