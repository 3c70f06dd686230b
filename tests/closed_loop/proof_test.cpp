#include <gtest/gtest.h>

#include <cmath>

#include "tests/closed_loop/flown.hpp"

/// Proof against self-deception: what the aircraft does must come from what it sees.
namespace understory {
namespace {

const std::vector<std::string> thick_forest{"forest.length_m=35", "forest.square_metres_per_tree=25"};
/// The blind aircraft looks at nothing, so one picture a second is enough.
const std::vector<std::string> blind{"perception.detector=none", "cameras.rate_hz=1"};

/// The first `count` seeds from 1000 up whose forest stands in the blind aircraft's way.
std::vector<int> blocked_seeds(std::size_t count) {
  std::vector<int> seeds;
  for (int seed = 1000; seeds.size() < count && seed < 1030; ++seed) {
    if (flown("forest", seed, with(thick_forest, blind)).outcome() == "collision") seeds.push_back(seed);
  }
  return seeds;
}

TEST(Proof, SeeingGetsThroughWhereBlindAndInvisibleForestDoNot) {
  const std::vector<int> seeds = blocked_seeds(6);
  ASSERT_EQ(seeds.size(), 6u);
  int seeing_passed = 0, invisible_hit = 0;
  for (const int seed : seeds) {
    const Flown seeing = flown("forest", seed, thick_forest);
    const Flown invisible = flown("forest", seed, with(thick_forest, {"forest.invisible=true"}));
    seeing_passed += seeing.outcome() == "goal";
    invisible_hit += invisible.outcome() == "collision";
    EXPECT_GT(seeing.remembered_points(), 100) << "seed " << seed;
    EXPECT_LT(invisible.remembered_points(), seeing.remembered_points() / 20) << "seed " << seed;
  }
  EXPECT_GE(seeing_passed, 4);
  EXPECT_GE(invisible_hit, 5);
}

TEST(Proof, AnIntangibleForestIsAvoidedAllTheSame) {
  const std::vector<std::string> harmless = with(thick_forest, {"forest.intangible=true"});
  int avoided = 0;
  const std::vector<int> seeds = blocked_seeds(3);
  for (const int seed : seeds) {
    const Flown blind_flight = flown("forest", seed, with(harmless, blind));
    EXPECT_EQ(blind_flight.outcome(), "goal") << "seed " << seed;  // it went right through them
    EXPECT_LT(blind_flight.minimum_clearance_m(), 0.05) << "seed " << seed;
    const Flown seeing = flown("forest", seed, harmless);
    avoided += seeing.outcome() == "goal" && seeing.minimum_clearance_m() > 0.1;
  }
  EXPECT_GE(avoided, 2);
}

TEST(Proof, UnderTheLensCapNothingIsSeen) {
  const std::vector<int> seeds = blocked_seeds(2);
  for (const int seed : seeds) {
    const Flown capped = flown("forest", seed, with(thick_forest, {"cameras.lens_cap=true"}));
    EXPECT_EQ(capped.detections(), 0) << "seed " << seed;
    EXPECT_EQ(capped.remembered_points(), 0) << "seed " << seed;
    EXPECT_EQ(capped.outcome(), "collision") << "seed " << seed;
  }
}

TEST(Proof, TheBlindAircraftDetectsNothingAndPlansStraight) {
  const Flown flight = flown("clear", 1000, with(blind, {"forest.length_m=20"}));
  EXPECT_EQ(flight.outcome(), "goal");
  EXPECT_EQ(flight.detections(), 0);
  EXPECT_EQ(flight.result.at("solved"), 0);
  EXPECT_EQ(flight.result.at("obstacle_ahead"), 0);
}

TEST(Proof, TheEstimateIsNeverTheTruth) {
  const Flown flight = flown("clear", 1000, with(blind, {"forest.length_m=20"}));
  const auto rows =
      columns(flight, {"t_s", "x_m", "est_x_m", "vx_world_mps", "est_vx_world_mps", "qy", "est_qy"});
  ASSERT_GT(rows.size(), 300u);
  int same = 0;
  for (const auto& row : rows) {
    if (row[0] < 0.6) continue;  // before and on the rail both may be known: at rest at the origin
    same += row[1] == row[2] && row[3] == row[4] && row[5] == row[6];
  }
  EXPECT_EQ(same, 0);
  EXPECT_GT(flight.result.at("position_error_mean_m"), 1e-3);

  const Flown told = flown("clear", 1000, with(blind, {"forest.length_m=20", "estimation.source=truth"}));
  EXPECT_LT(told.result.at("position_error_max_m"),
            flight.result.at("position_error_mean_m"));  // the oracle has no error
}

TEST(Proof, APitotBiasMovesTheEstimate) {
  // A filter that believes what disagrees: the one that flies finds the fault and leaves the pitot out.
  const std::vector<std::string> settings =
      with(blind, {"forest.length_m=20", "estimation.filter.distrust.exclude=false"});
  const auto estimated_less_true_mps = [](const Flown& flight) {
    double sum = 0;
    int count = 0;
    for (const auto& row : columns(flight, {"t_s", "vx_world_mps", "est_vx_world_mps"})) {
      if (row[0] < 1.5) continue;
      sum += row[2] - row[1], ++count;
    }
    return sum / count;
  };
  const double honest = estimated_less_true_mps(flown("clear", 1000, settings));
  const double biased =
      estimated_less_true_mps(flown("clear", 1000, with(settings, {"sensors.pitot.bias_mps=3"})));
  EXPECT_LT(std::abs(honest), 0.6);
  EXPECT_GT(biased - honest, 0.3);  // towards the bias, by more than noise does
}

}  // namespace
}  // namespace understory
