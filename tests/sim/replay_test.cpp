#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/validation/page.hpp"
#include "tests/validation/replay_fit.hpp"

/// The real left jog (tests/data/flight): the record, its replay, the fit. Its tolerances are checked where
/// the page is (validate_test.cpp).
namespace understory {
namespace {

struct Jog : testing::Test {
  Airframe airframe;
  FreeFlight air{airframe};
  FlightRecord record = real_left_jog();
};

/// The mended rates are the attitude's own turning: they correlate by more than 0.97.
TEST_F(Jog, MendedRatesTurnTheAttitude) {
  constexpr std::size_t apart = 4;
  for (int axis = 0; axis < 3; ++axis) {
    double products = 0, rates = 0, turns = 0;
    for (std::size_t i = 0; i + apart < record.size(); ++i) {
      const Eigen::AngleAxisd turn(record[i].R_world_body.transpose() * record[i + apart].R_world_body);
      const double turned = turn.angle() * turn.axis()[axis];
      const double rate = record[i + apart / 2].angular_rate_body_radps[axis];
      products += turned * rate;
      rates += rate * rate;
      turns += turned * turned;
    }
    EXPECT_GT(products / std::sqrt(rates * turns), 0.985) << "axis " << axis;
  }
}

TEST_F(Jog, IsTheManoeuvreItSays) {
  ASSERT_EQ(record.size(), 151u);
  double maximum_roll_rad = 0;
  for (const FlightMoment& moment : record)
    maximum_roll_rad = std::max(maximum_roll_rad, std::abs(moment.roll_rad()));
  EXPECT_NEAR(maximum_roll_rad / degree, 64, 2);
  EXPECT_EQ(record.front().position_world.z(), 0);  // the height is the integral of the velocity
  EXPECT_NEAR(record.back().position_world.x(), 16.7, 0.05);
  EXPECT_NEAR(record.back().position_world.y(), 6.1, 0.05);
  const double climb_mps = (record[50].R_world_body * record[50].velocity_body_mps).z();
  const double slope = (record[51].position_world - record[49].position_world).z() / 0.02;
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
    EXPECT_LT(std::abs(error_at(error, times_s[i]).height_m), 1) << times_s[i];
  }
}

/// A record made by the simulator itself gives its parameters back.
TEST_F(Jog, FitFindsWhatMadeTheRecord) {
  Airframe other = airframe;
  other.rate_damping_nmspr.x() *= 1.2;
  other.elevon_lift_factor *= 0.9;
  FlightRecord made = replay(air, other, record);
  for (std::size_t i = 0; i < made.size(); ++i) made[i].controls = record[i].controls;
  const std::vector<FreeParameter>& all = free_parameters();
  const ReplayFit fit = fit_replay(air, airframe, made, {&all[0], &all[1], &all[2]}, 0, 1.5);
  EXPECT_NEAR(fit.airframe.rate_damping_nmspr.x() / other.rate_damping_nmspr.x(), 1, 1e-3);
  EXPECT_NEAR(fit.airframe.rate_damping_nmspr.y() / other.rate_damping_nmspr.y(), 1, 1e-3);
  EXPECT_NEAR(fit.airframe.elevon_lift_factor / other.elevon_lift_factor, 1, 1e-3);
}

}  // namespace
}  // namespace understory
