#include <gtest/gtest.h>

#include <algorithm>

#include "sim/sensors/sensors_config.hpp"
#include "tests/validation/consistency.hpp"
#include "tests/validation/consistency_section.hpp"
#include "tests/validation/estimator_trial.hpp"
#include "tests/validation/flight_series.hpp"

/// The estimator along recorded forest flights: a small set of what `understory_validate --only estimator`
/// does with hundreds.
namespace understory {
namespace {

const std::filesystem::path root = UNDERSTORY_SOURCE_DIR;

TEST(Consistency, QuantilesAgreeWithTables) {
  // Abramowitz and Stegun 1964, table 26.8.
  EXPECT_NEAR(chi_square_quantile_of_many(0.975, 30), 46.979, 0.2);
  EXPECT_NEAR(chi_square_quantile_of_many(0.025, 30), 16.791, 0.1);
  EXPECT_NEAR(chi_square_quantile_of_many(0.95, 100), 124.342, 0.2);
}

TEST(EstimatorTrial, IsConsistentWithMatchedNoiseInCalmAir) {
  std::vector<SquaredErrors> trials;
  measure_flights(
      12, [](int i) { return matched_scenario(2000 + static_cast<std::uint64_t>(i), root); }, root / "models",
      consistency_to_s + 1,
      [&](int number, const RecordedFlight& flight) {
        const TrialConfig config = matched_trial(flight.scenario, 9000 + static_cast<std::uint64_t>(number));
        const double release_s = static_cast<double>(flight.release_step) / physics_rate_hz;
        trials.push_back(
            squared_errors(run_trial(flight, config), release_s, consistency_from_s, consistency_to_s));
      });
  ASSERT_GE(trials.size(), 10u);
  for (const Consistency& one : consistency(trials)) {
    if (one.name == "sideslip") continue;  // not a measurement in this trial
    // The position's error hangs on one draw of the launch's heading a flight: time does not average it.
    if (one.name != "position drift") {
      EXPECT_GE(one.share_inside, 0.85) << one.name;
    }
    EXPECT_GT(one.mean_over_degrees, 0.4) << one.name;
    EXPECT_LT(one.mean_over_degrees, 1.7) << one.name;
  }
}

TEST(EstimatorTrial, IdealSensorsHardlyDrift) {
  const Scenario scenario = matched_scenario(2000, root);
  const RecordedFlight flight = recorded_flight(scenario, root / "models");
  TrialConfig config = matched_trial(scenario, 1);
  config.sensors = sensors_of_grade(SensorGrade::ideal);
  config.filter.start.yaw_rad = 0;
  const std::vector<Drift> found = drifts(flight, run_trial(flight, config), 10);
  ASSERT_GT(found.size(), 50u);
  for (const Drift& drift : found) EXPECT_LT(drift.total_m(), 0.04) << drift.seen_s;
}

TEST(EstimatorTrial, ASecondDepthFindsTheWindThatNothingElseShows) {
  const RecordedFlight flight = recorded_flight(forest_in({3, false}, 2003, root), root / "models");
  const Sightings seen = sightings(flight, {10.1, 5.0});
  const auto velocity_error_at_the_end = [&](bool told) {
    TrialConfig config;
    config.filter = windy_filter();
    config.sensors = flight.scenario.sensors.sensors;
    config.ground_velocity_unknown = true;
    config.sightings = &seen;
    config.resightings.enabled = told;
    return error_of(run_trial(flight, config).back()).segment<3>(velocity_block).norm();
  };
  EXPECT_LT(2 * velocity_error_at_the_end(true), velocity_error_at_the_end(false));
}

}  // namespace
}  // namespace understory
