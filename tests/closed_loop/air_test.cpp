#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "planning/flight_model.hpp"
#include "sim/aircraft/aerodynamics.hpp"
#include "tests/closed_loop/flown.hpp"

namespace understory {
namespace {

const std::vector<std::string> clear_field{"perception.detector=true_depth", "estimation.source=truth",
                                           "forest.length_m=5"};

TEST(Air, WindySeedsRepeatAndDiffer) {
  const std::vector<std::string> eyes_shut{"perception.detector=none", "forest.length_m=10"};
  const Flown one = flown("windy", 1000, eyes_shut);
  EXPECT_EQ(one.digest(), flown("windy", 1000, eyes_shut).digest());
  EXPECT_NE(one.digest(), flown("windy", 1000, with(eyes_shut, {"wind.turbulence_wind20_mps=0"})).digest());
}

// The wind triangle: the stack knows its way over ground and flies straight ahead, with the nose turned into
// the wind by asin(wind / airspeed).
TEST(Air, CrosswindTurnsTheNoseIntoIt) {
  const Flown crossed =
      flown("clear", 1000, with(clear_field, {"forest.length_m=30", "wind_world_mps=[0,3,0]"}));
  const std::vector<double> end =
      columns(crossed, {"qw", "qx", "qy", "qz", "vx_world_mps", "vy_world_mps", "vz_world_mps"}).back();
  const Eigen::Vector3d nose = Eigen::Quaterniond(end[0], end[1], end[2], end[3]) * Eigen::Vector3d::UnitX();
  const double airspeed_mps = Eigen::Vector3d(end[4], end[5] - 3, end[6]).norm();
  EXPECT_NEAR(end[5], 0, 0.6);  // 3 if the nose pointed ahead
  EXPECT_NEAR(std::atan2(nose.y(), nose.x()), std::atan2(end[5], end[4]) - std::asin(3 / airspeed_mps), 0.03);
}

// The catapult pitches the aircraft by the trim's angle of attack of the airframe that flies.
TEST(Mismatch, TheSimulatorFliesThePerturbedAirframe) {
  const Flown heavy = flown("clear", 1000, with(clear_field, {"mismatch.mass_percent=-20"}));
  const auto attitude = columns(heavy, {"qw", "qy"}).front();
  Airframe light;
  light.mass_kg *= 0.8;
  const double expected_rad = 0.20 + straight_trim(light, 12).value().angle_of_attack_rad;
  EXPECT_NEAR(2 * std::atan2(-attitude[1], attitude[0]), expected_rad, 1e-5);  // nose up is about -y
}

// The throttle shows the thrust that the stack expects level flight to need: thrust = level + gain (cruise -
// speed).
TEST(Mismatch, TheStackKeepsItsOwnAirframe) {
  const auto level_thrust_n = [&](const std::vector<std::string>& settings) {
    constexpr std::size_t released = 120;  // 0.6 s at 200 Hz
    const std::vector<double> row =
        columns(flown("clear", 1000, with(with(clear_field, {"airframe.max_thrust_n=9"}), settings)),
                {"est_vx_world_mps", "est_vy_world_mps", "est_vz_world_mps", "thrust_command_n"})[released];
    const FlightModelConfig config;
    return row[3] -
           config.speed_gain_n_per_mps * (config.cruise_speed_mps - Eigen::Vector3d(row.data()).norm());
  };
  const double believed_n = level_thrust_n({});
  EXPECT_NEAR(level_thrust_n({"mismatch.mass_percent=-20"}), believed_n, 1e-3);
  EXPECT_LT(level_thrust_n({"airframe.mass_kg=0.51873"}), believed_n - 0.3);
}

}  // namespace
}  // namespace understory
