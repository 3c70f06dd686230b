#include <gtest/gtest.h>

#include <algorithm>

#include "scenarios/scenario/scenario_io.hpp"
#include "sim/aircraft/aerodynamics.hpp"
#include "sim/sensors/sensors_config.hpp"
#include "tests/validation/consistency.hpp"
#include "tests/validation/mismatch.hpp"

/// The estimator along recorded forest flights: a small set of what `understory_validate estimator`
/// does with hundreds.
namespace understory {
namespace {

TEST(EstimatorTrial, IsConsistentWithMatchedNoiseInCalmAir) {
  std::vector<std::vector<SquaredMoment>> trials;
  measure_flights(
      12, [](int i) { return matched_scenario(2000 + static_cast<std::uint64_t>(i)); }, consistency_minimum_s,
      [&](int number, const FlightTrace& flight) {
        trials.push_back(
            squared_moments(flight, matched_trial(flight, 9000 + static_cast<std::uint64_t>(number))));
      });
  ASSERT_GE(trials.size(), 10u);
  for (const Consistency& one : consistency(trials)) {
    EXPECT_NE(one.name, "sideslip");  // not a measurement in this trial
    // The position's error hangs on one draw of the launch's heading a flight: time does not average it.
    if (one.name != "position drift") {
      EXPECT_GE(one.share_inside, 0.85) << one.name;
    }
    EXPECT_GT(one.mean_over_degrees, 0.4) << one.name;
    EXPECT_LT(one.mean_over_degrees, 1.7) << one.name;
  }
}

TEST(EstimatorTrial, IdealSensorsHardlyDrift) {
  const FlightTrace flight = traced_flight(matched_scenario(2000));
  TrialConfig config = matched_trial(flight, 1);
  config.sensors = sensors_of_grade(SensorGrade::ideal);
  config.filter.start.yaw_rad = 0;
  const std::vector<Drift> found = drifts(flight, run_trial(flight, config), 10);
  ASSERT_GT(found.size(), 50u);
  for (const Drift& drift : found) EXPECT_LT(drift.total_m(), 0.04);
}

TEST(EstimatorTrial, ASecondDepthFindsTheWindThatNothingElseShows) {
  const FlightTrace flight = traced_flight(forest_in({3, false}, 2003));
  const Sightings seen = sightings(flight, {10.1, 5.0});
  const auto velocity_error_at_the_end = [&](bool told) {
    TrialConfig config;
    config.filter = windy_filter();
    config.sensors = flight.scenario.sensors;
    config.ground_velocity_unknown = true;
    config.sightings = &seen;
    config.resightings.enabled = told;
    return run_trial(flight, config).back().error().segment<3>(velocity_block).norm();
  };
  EXPECT_LT(2 * velocity_error_at_the_end(true), velocity_error_at_the_end(false));
}

const std::vector<std::string> seen_forest{"forest.length_m=20", "forest.square_metres_per_tree=25",
                                           "perception.detector=true_depth"};

Scenario forest(const std::vector<std::string>& settings) {
  return load_scenario(UNDERSTORY_SOURCE_DIR "/scenarios/library/forest.yaml", settings);
}

/// The filter that is run again along the truth is the one that flew.
TEST(MismatchPage, TheEstimateFollowedIsTheOneThatFlew) {
  Scenario scenario = forest(seen_forest);
  scenario.mismatch = adverse(10);
  const FlightTrace flight = traced_flight(scenario, "filter");
  double maximum_m = 0;
  for (const TrialMoment& moment : run_trial(flight, trial_of(flight, scenario.sensor_seed())))
    if (moment.truth.t_ns * physics_rate_hz >= flight.release_step * 1'000'000'000)
      maximum_m = std::max(maximum_m, moment.error().segment<3>(position_block).norm());
  EXPECT_GT(flight.result.position_error_max_m, 0.01);
  EXPECT_NEAR(maximum_m, flight.result.position_error_max_m, 1e-9);
}

TEST(MismatchPage, TallyCountsEveryFlightAndEveryFilter) {
  Scenario scenario = forest(seen_forest);
  const FlightTally tally = fly_seeds(scenario, {scenario.estimation.filter()}, {1000, 2});
  EXPECT_EQ(tally.flights(), 2);
  EXPECT_EQ(tally.goals(), 2);
  EXPECT_NEAR(tally.mean_speed_mps(), 12, 1);
  ASSERT_EQ(tally.others.size(), 1U);
  EXPECT_GT(tally.drift.total_m.size(), 10U);
  EXPECT_EQ(tally.others.front().total_m, tally.drift.total_m);  // the same filter, the same samples
}

TEST(MismatchPage, DriftsQuantileLiesBetweenItsNeighbours) {
  DriftTally tally;
  EXPECT_TRUE(std::isnan(tally.quantile_m(0.95)));
  for (const double metres : {4.0, 1.0, 2.0, 3.0, 5.0}) {
    Drift drift;
    drift.vertical_m = -metres;
    drift.stated_sigma_m = metres / 2;
    tally.add({drift});
  }
  EXPECT_DOUBLE_EQ(tally.quantile_m(0), 1);
  EXPECT_DOUBLE_EQ(tally.quantile_m(0.5), 3);
  EXPECT_DOUBLE_EQ(tally.quantile_m(0.95), 4.8);
  EXPECT_DOUBLE_EQ(tally.quantile_m(1), 5);
  EXPECT_DOUBLE_EQ(tally.over_stated(), 2);
}

/// Every part of the adverse aircraft costs level flight or time to act, and together they end it.
TEST(MismatchPage, AdverseIsAdverse) {
  Scenario scenario = forest({});
  EXPECT_TRUE(straight_trim(scenario.flown_airframe(), 10));
  scenario.mismatch = adverse(20);
  EXPECT_FALSE(straight_trim(scenario.flown_airframe(), 10));
  EXPECT_GT(scenario.flown_airframe().input_delay_s, scenario.airframe.input_delay_s);
  EXPECT_LT(scenario.flown_airframe().rate_damping_nmspr.x(), scenario.airframe.rate_damping_nmspr.x());
  EXPECT_TRUE(mismatch_conditions().front().what.empty());  // the page compares with the model itself
}

}  // namespace
}  // namespace understory
