#include <gtest/gtest.h>

#include "scenarios/scenario/scenario_io.hpp"
#include "sim/aircraft/aerodynamics.hpp"
#include "tests/closed_loop/flown.hpp"
#include "tests/validation/mismatch_conditions.hpp"
#include "tests/validation/mismatch_flights.hpp"
#include "tests/validation/recorded_flight.hpp"

/// What the page on model mismatch is made from.
namespace understory {
namespace {

const std::vector<std::string> short_forest{"forest.length_m=20", "forest.square_metres_per_tree=25",
                                            "perception.detector=true_depth"};
constexpr const char* models = UNDERSTORY_SOURCE_DIR "/models";

Scenario forest(const std::vector<std::string>& settings) {
  return load_scenario(UNDERSTORY_SOURCE_DIR "/scenarios/library/forest.yaml", settings);
}

/// The page flies all of them in one process. OMPL's one generator must not make them differ.
TEST(MismatchPage, FlightsOfOneProcessAreThoseOfAProcessEach) {
  for (const std::uint64_t seed : {1000, 1001, 1000}) {
    Scenario scenario = forest(short_forest);
    scenario.seed = seed;
    scenario.mismatch = adverse(10);
    const std::vector<std::string> settings{"mismatch.mass_percent=10", "mismatch.lift_percent=-10",
                                            "mismatch.drag_percent=10", "mismatch.damping_percent=-10",
                                            "mismatch.delay_percent=50"};
    EXPECT_EQ(recorded_flight(scenario, models, StateKind::filter).result.digest,
              flown("forest", static_cast<int>(seed), with(short_forest, settings)).digest());
  }
}

/// The filter that is run again along the truth is the one that flew.
TEST(MismatchPage, TheEstimateFollowedIsTheOneThatFlew) {
  Scenario scenario = forest(short_forest);
  scenario.mismatch = adverse(10);
  const RecordedFlight flight = recorded_flight(scenario, models, StateKind::filter);
  TrialConfig config;
  config.filter = scenario.estimation.filter;
  config.sensors = scenario.sensors.sensors;
  config.sensor_seed = scenario.sensor_seed();
  double maximum_m = 0;
  for (const TrialMoment& moment : run_trial(flight, config))
    if (moment.truth.t_ns * physics_rate_hz >= flight.release_step * 1'000'000'000)
      maximum_m = std::max(maximum_m, error_of(moment).segment<3>(position_block).norm());
  EXPECT_GT(flight.result.position_error_max_m, 0.01);
  EXPECT_NEAR(maximum_m, flight.result.position_error_max_m, 1e-9);
}

TEST(MismatchPage, TallyCountsEveryFlightAndEveryFilter) {
  Scenario scenario = forest(short_forest);
  const FlightTally tally = fly_seeds(scenario, {scenario.estimation.filter}, {1000, 2}, models);
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
