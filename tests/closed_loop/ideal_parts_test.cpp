#include "scenarios/flight/ideal_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "perception/io/text_file.hpp"
#include "scenarios/flight/clearance.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "tests/closed_loop/flown.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

const FlightMachine ideal_machine{root / "models"};
constexpr double from_s = 1.2;
/// The map drops points without six neighbours, so that an ideal one makes a difference.
const std::vector<std::string> dense_start{"forest.square_metres_per_tree=16", "forest.clear_m=5",
                                           "time_limit_s=2", "autopilot.map.min_neighbours=6"};

/// What a flight did, step by step, and what it detected.
struct WatchedFlight : FlightObserver {
  std::vector<Truth> truths;
  std::vector<State> states;
  KnownHits hits;
  std::vector<std::int64_t> latencies_ns;
  PlannerCounts counts;

  explicit WatchedFlight(const std::vector<std::string>& more) {
    std::vector<std::string> settings = dense_start;
    settings.insert(settings.end(), more.begin(), more.end());
    Flight flight(load_scenario(root / "scenarios/library/forest.yaml", settings), ideal_machine, {this});
    while (!flight.outcome()) {
      truths.push_back(flight.truth());
      states.push_back(flight.state());
      flight.step();
    }
    counts = flight.planner_counts();
  }
  void on_frame(const Flight& flight) override {
    hits[flight.frame().t_ns] = flight.hits();
    latencies_ns.push_back(flight.clock().t_ns() - flight.frame().t_ns);
  }
};

bool same(const Truth& a, const Truth& b) {
  return a.T_world_body.matrix() == b.T_world_body.matrix() && a.velocity_world_mps == b.velocity_world_mps;
}

/// Steps until the two flights differ; their length where they do not.
std::size_t equal_steps(const WatchedFlight& a, const WatchedFlight& b) {
  std::size_t step = 0;
  while (step < a.truths.size() && step < b.truths.size() && same(a.truths[step], b.truths[step])) ++step;
  return step;
}

const WatchedFlight& plain() {
  static const WatchedFlight flown({});
  return flown;
}

WatchedFlight ideal(const std::string& part, int redraw = 0, const std::vector<std::string>& more = {}) {
  std::vector<std::string> settings{"ideal.from_s=" + std::to_string(from_s),
                                    "ideal.redraw=" + std::to_string(redraw)};
  if (!part.empty()) settings.push_back("ideal.parts=[" + part + "]");
  settings.insert(settings.end(), more.begin(), more.end());
  return WatchedFlight(settings);
}

const auto switch_step = static_cast<std::size_t>(from_s * physics_rate_hz);

class IdealPart : public testing::TestWithParam<std::string_view> {};

TEST_P(IdealPart, ChangesNothingBeforeItsMoment) {
  const WatchedFlight flown = ideal(std::string(GetParam()), 1);
  const std::size_t equal = equal_steps(flown, plain());
  EXPECT_GE(equal, switch_step);
  EXPECT_LT(equal, switch_step + physics_rate_hz / 4) << "and changes something after it";
  const WatchedFlight control = ideal("", 1);
  EXPECT_LT(equal_steps(flown, control), control.truths.size()) << "which not only the noise does";
}

INSTANTIATE_TEST_SUITE_P(All, IdealPart, testing::ValuesIn(ideal_part_names));

TEST(IdealParts, WithoutThemAndWithoutRedrawTheFlightIsTheSame) {
  EXPECT_EQ(equal_steps(ideal("", 0), plain()), plain().truths.size());
}

TEST(IdealParts, ARedrawIsAnotherFlightForEachSeedAndTheSameForOne) {
  const WatchedFlight one = ideal("", 1), again = ideal("", 1), other = ideal("", 2);
  EXPECT_EQ(equal_steps(one, again), one.truths.size());
  EXPECT_LT(equal_steps(one, other), one.truths.size());
  EXPECT_GE(equal_steps(one, other), switch_step);
}

TEST(IdealParts, WithKnownHitsTheFlightIsTheSameWithoutPictures) {
  const support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "hits";
  write_whole_file(file, to_bytes(plain().hits));
  for (const char* part : {"", "state", "detection"}) {
    const WatchedFlight drawn = ideal(part, 3), known = ideal(part, 3, {"ideal.hits=" + file.string()});
    EXPECT_EQ(equal_steps(drawn, known), drawn.truths.size()) << part;
  }
  // A frozen picture is one of before the moment: it is drawn.
  const std::string freeze = fmt::format("faults=[{{sensor: camera, kind: freeze, at_s: {}}}]", from_s - 0.1);
  const WatchedFlight frozen = WatchedFlight({freeze});
  write_whole_file(file, to_bytes(frozen.hits));
  const WatchedFlight drawn = ideal("", 3, {freeze}),
                      known = ideal("", 3, {freeze, "ideal.hits=" + file.string()});
  EXPECT_EQ(equal_steps(drawn, known), drawn.truths.size());
}

TEST(IdealParts, HitsComeBackWholeAndDamagedFilesAreRefused) {
  const std::string bytes = to_bytes(plain().hits);
  EXPECT_EQ(to_bytes(known_hits_from_bytes(bytes, "hits")), bytes);
  EXPECT_THROW(known_hits_from_bytes(bytes.substr(0, bytes.size() - 1), "hits"), ScenarioError);
  EXPECT_THROW(known_hits_from_bytes("something else", "hits"), ScenarioError);
}

TEST(IdealParts, IdealStateIsTheTruth) {
  const WatchedFlight flown = ideal("state");
  for (std::size_t step = switch_step + 10; step < flown.truths.size(); step += 50) {
    const Eigen::Vector3d error_m =
        flown.states[step].T_world_body.translation() - flown.truths[step].T_world_body.translation();
    EXPECT_LT(error_m.norm(), 0.15) << "the state is as old as the newest sample: 5 ms, 6 cm";
  }
}

TEST(IdealParts, IdealDetectionHitsObstaclesAndNothingElse) {
  const WatchedFlight flown = ideal("detection");
  const Scenario scenario = load_scenario(root / "scenarios/library/forest.yaml", dense_start);
  const std::vector<Obstacle> obstacles = course_obstacles(scenario);
  const StereoRig rig = Flight(scenario, ideal_machine).rig().rig;
  std::size_t hits = 0;
  for (const auto& [t_ns, in_frame] : flown.hits) {
    if (t_ns < std::int64_t{1'300'000'000}) continue;
    const auto truth = std::ranges::find(flown.truths, t_ns, &Truth::t_ns);
    if (truth == flown.truths.end()) continue;
    for (const StereoHit& hit : in_frame) {
      const Eigen::Vector3d place = truth->T_world_body * rig.T_body_camera * hit.position_camera;
      EXPECT_TRUE(std::ranges::any_of(
          obstacles, [&](const Obstacle& one) { return std::abs(distance_m(place, one)) < 0.02; }));
      ++hits;
    }
  }
  EXPECT_GT(hits, 20);
}

TEST(IdealParts, WithoutLatencyAFrameIsThereAtOnceAndThoseUnderWayAreNotLost) {
  const std::vector<std::string> slow{"cameras.latency_s=0.06"};
  const WatchedFlight late(slow), flown = ideal("latency", 0, slow);
  EXPECT_EQ(late.latencies_ns.back(), 60'000'000);
  EXPECT_EQ(flown.latencies_ns.back(), 0);
  for (const auto& [t_ns, hits] : late.hits) EXPECT_TRUE(flown.hits.contains(t_ns)) << t_ns;
  EXPECT_NEAR(static_cast<double>(flown.hits.size()), static_cast<double>(late.hits.size()) + 7, 2);
}

TEST(IdealParts, IdealSearchSearchesInPlaceOfAPlannerThatDoesNot) {
  const WatchedFlight straight({"autopilot.method=straight"});
  const WatchedFlight searching({"autopilot.method=straight", "ideal.parts=[search]", "ideal.from_s=1.2"});
  EXPECT_EQ(straight.counts.searches, 0);
  EXPECT_GT(searching.counts.searches, 0);
  EXPECT_GE(straight.truths[equal_steps(straight, searching)].t_ns, 1'200'000'000);
}

TEST(IdealParts, TheModelsStateAndItsPoseAreInverse) {
  FlightState state;
  state.position_world = {3, -2, 4};
  state.speed_mps = 11;
  state.heading_rad = 0.7;
  state.climb_angle_rad = -0.2;
  state.bank_rad = 1.1;
  state.angle_of_attack_rad = 0.25;
  state.sideslip_rad = -0.1;
  const Eigen::Isometry3d pose = pose_of(state);
  EXPECT_TRUE(pose.linear().isUnitary(1e-12));
  const FlightState back = flight_state(
      pose, pose.linear().transpose() * (state.speed_mps * flight_direction_world(state)), {0, 0, 0});
  EXPECT_NEAR(back.heading_rad, state.heading_rad, 1e-12);
  EXPECT_NEAR(back.climb_angle_rad, state.climb_angle_rad, 1e-12);
  EXPECT_NEAR(back.bank_rad, state.bank_rad, 1e-12);
  EXPECT_NEAR(back.angle_of_attack_rad, state.angle_of_attack_rad, 1e-12);
  EXPECT_NEAR(back.sideslip_rad, state.sideslip_rad, 1e-12);
}

TEST(IdealParts, IdealTrackingLeavesTheEstimateAsGoodAsItWas) {
  const WatchedFlight flown = ideal("tracking");
  const Eigen::Vector3d error_m =
      flown.states.back().T_world_body.translation() - flown.truths.back().T_world_body.translation();
  EXPECT_LT(error_m.head<2>().norm(), 0.4);
}

TEST(IdealParts, WrongOnesAreRefusedInOneLine) {
  EXPECT_THROW(load_scenario(root / "scenarios/library/forest.yaml", {"ideal.parts=[eyes]"}), ScenarioError);
  EXPECT_THROW(load_scenario(root / "scenarios/library/forest.yaml", {"ideal.hits=hits"}), ScenarioError);
}

}  // namespace
}  // namespace understory
