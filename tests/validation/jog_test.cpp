#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenarios/config/config_tree.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/validation/path_tracking.hpp"
#include "tests/validation/replay_fit.hpp"

/// The real left jog (tests/data/flight), open loop and closed, against the tolerances that are stated for
/// it.
namespace understory {
namespace {

constexpr double degree = std::numbers::pi / 180;

struct Jog : testing::Test {
  Airframe airframe;
  FreeFlight air{UNDERSTORY_SOURCE_DIR "/models", airframe};
  FlightRecord record = read_flight_record(UNDERSTORY_SOURCE_DIR "/tests/data/flight/left_jog.csv");
};

/// The mended rates are the attitude's own turning: they correlate by more than 0.97.
TEST_F(Jog, MendedRatesTurnTheAttitude) {
  constexpr std::size_t apart = 4;
  for (int axis = 0; axis < 3; ++axis) {
    double products = 0, rates = 0, turns = 0;
    for (std::size_t i = 0; i + apart < record.moments.size(); ++i) {
      const Eigen::AngleAxisd turn(record.moments[i].R_world_body.transpose() *
                                   record.moments[i + apart].R_world_body);
      const double turned = turn.angle() * turn.axis()[axis];
      const double rate = record.moments[i + apart / 2].angular_rate_body_radps[axis];
      products += turned * rate;
      rates += rate * rate;
      turns += turned * turned;
    }
    EXPECT_GT(products / std::sqrt(rates * turns), 0.985) << "axis " << axis;
  }
}

TEST_F(Jog, HeightIsTheIntegralOfTheVelocity) {
  EXPECT_EQ(record.moments.front().position_world.z(), 0);
  EXPECT_NEAR(record.moments.back().position_world.x(), 16.7, 0.05);
  EXPECT_NEAR(record.moments.back().position_world.y(), 6.1, 0.05);
  const double climb_mps = (record.moments[50].R_world_body * record.moments[50].velocity_body_mps).z();
  const double slope = (record.moments[51].position_world - record.moments[49].position_world).z() / 0.02;
  EXPECT_NEAR(slope, climb_mps, 0.1);
}

/// docs/sources.md [14]: 0.12, 0.19, 0.26, 0.39 m and 3, 2, -8, 4 deg at 0.25, 0.5, 1.0 and 1.5 s, unfitted.
TEST_F(Jog, UnfittedReplayIsTheKnownOne) {
  const std::vector<ReplayError> error = errors(replay(air, airframe, record), record);
  const double times_s[] = {0.25, 0.5, 1.0, 1.5}, horizontal_m[] = {0.12, 0.19, 0.26, 0.39},
               roll_deg[] = {3, 2, -8, 4};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(error_at(error, times_s[i]).horizontal_m, horizontal_m[i], 0.08) << times_s[i];
    EXPECT_NEAR(error_at(error, times_s[i]).roll_rad / degree, roll_deg[i], 1.5) << times_s[i];
  }
}

TEST_F(Jog, FittedReplayKeepsItsTolerances) {
  const ReplayFit fit = fit_what_can_be_told(air, airframe, record, 0, 0.75);
  EXPECT_LE(fit.parameters.size(), 3u);
  EXPECT_LT(fit.sum_of_squares, fit.unfitted_sum_of_squares);
  for (const FittedParameter& fitted : fit.parameters) EXPECT_LT(fitted.share, 0.5) << fitted.parameter->name;
  const std::vector<ReplayError> error = errors(replay(air, fit.airframe, record), record);
  EXPECT_LE(error_at(error, 0.5).horizontal_m, 0.20);
  EXPECT_LE(error_at(error, 1.0).horizontal_m, 0.25);
  EXPECT_LE(error_at(error, 1.5).horizontal_m, 0.40);
  EXPECT_LE(maximum_height_m(error), 0.35);
  EXPECT_LE(std::abs(error_at(error, 0.5).roll_rad) / degree, 4);
  EXPECT_LE(rms_roll_rad(error) / degree, 4.5);
}

/// A record made by the simulator itself gives its parameters back.
TEST_F(Jog, FitFindsWhatMadeTheRecord) {
  Airframe other = airframe;
  other.rate_damping_nmspr.x() *= 1.2;
  other.elevon_lift_factor *= 0.9;
  FlightRecord made = record;
  const Replay flown = replay(air, other, record);
  for (std::size_t i = 0; i < flown.size(); ++i) {
    const Eigen::Matrix3d& attitude = flown[i].R_world_body;
    made.moments[i].position_world = flown[i].position_world;
    made.moments[i].roll_rad = std::atan2(attitude(2, 1), attitude(2, 2));
  }
  const std::vector<FreeParameter>& all = free_parameters();
  const ReplayFit fit = fit_replay(air, airframe, made, {&all[0], &all[1], &all[2]}, 0, 1.5);
  EXPECT_NEAR(fit.airframe.rate_damping_nmspr.x() / other.rate_damping_nmspr.x(), 1, 1e-3);
  EXPECT_NEAR(fit.airframe.rate_damping_nmspr.y() / other.rate_damping_nmspr.y(), 1, 1e-3);
  EXPECT_NEAR(fit.airframe.elevon_lift_factor / other.elevon_lift_factor, 1, 1e-3);
}

TEST_F(Jog, FollowerStaysOnThePath) {
  TrackingConfig config;
  config.flight_model.cruise_speed_mps = 12.24;  // the record's mean
  for (const ReplayedMoment& moment : track(air, airframe, config, record))
    EXPECT_LE(distance_to_path_m(record, moment.position_world), 0.40) << moment.t_s;
}

TEST(FlightRecord, RefusesWhatIsNone) {
  const support::TemporaryFolder folder;
  EXPECT_THROW(read_flight_record(folder.path() / "missing.csv"), ScenarioError);
  EXPECT_THROW(read_flight_record(folder.write("empty.csv", "")), ScenarioError);
  EXPECT_THROW(read_flight_record(folder.write("short.csv", "0,1,2\n0,1,2\n")), ScenarioError);
  EXPECT_THROW(read_flight_record(folder.write("word.csv", "0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,x\n")),
               ScenarioError);
}

}  // namespace
}  // namespace understory
