#include "scenarios/flight/flight.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "scenarios/flight/flight_logger.hpp"
#include "scenarios/flight/flight_story.hpp"
#include "scenarios/flight/referee.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "sim/render/offscreen_backend.hpp"
#include "tests/closed_loop/flown.hpp"

/// The flight as an object, against the program's flights in processes of their own.
namespace understory {
namespace {

const FlightMachine machine{root / "models"};
const std::vector<std::string> twelve_metres{"forest.length_m=12", "forest.square_metres_per_tree=16"};

Scenario forest(int seed, std::vector<std::string> settings = twelve_metres) {
  settings.push_back("seed=" + std::to_string(seed));
  return load_scenario(root / "scenarios/library/forest.yaml", settings);
}

/// A flight and its record.
struct Recorded {
  explicit Recorded(const Scenario& scenario, std::vector<FlightObserver*> more = {})
      : flight(scenario, machine, with_logger(std::move(more))) {}
  std::vector<FlightObserver*> with_logger(std::vector<FlightObserver*> observers) {
    observers.push_back(&logger);
    return observers;
  }
  FlightResult flown() {
    while (!flight.outcome()) flight.step();
    return logger.log().result;
  }

  FlightLogger logger;
  Flight flight;
};

TEST(Flight, TheSecondOfAProcessIsAsInAFreshOne) {
  Recorded(forest(1000)).flown();
  const FlightResult second = Recorded(forest(1001)).flown();
  EXPECT_GT(second.planner.searches, 0);  // OMPL was asked, in both
  EXPECT_EQ(second.digest, flown("forest", 1001, twelve_metres).digest());
}

TEST(Flight, TwoOpenAtOnceAreAsAlone) {
  Recorded one(forest(1000)), other(forest(1001));
  while (!one.flight.outcome() || !other.flight.outcome()) {
    one.flight.step();
    other.flight.step();
  }
  EXPECT_EQ(one.flown().digest, flown("forest", 1000, twelve_metres).digest());
  EXPECT_EQ(other.flown().digest, flown("forest", 1001, twelve_metres).digest());
}

TEST(Referee, SidesEndNoFlightOnALongCourse) {
  const auto judged = [](const char* length, const Eigen::Vector3d& place) {
    Truth truth;
    truth.T_world_body.translation() = place;
    return Referee(forest(1, {length})).outcome_at(truth, Contact::none, true);
  };
  for (const Eigen::Vector3d& aside : {Eigen::Vector3d(30, 40, 4), {30, -40, 4}, {-40, 0, 4}}) {
    EXPECT_EQ(judged("forest.length_m=60", aside), Outcome::out_of_bounds);
    EXPECT_EQ(judged("forest.length_m=1000", aside), std::nullopt);
  }
  EXPECT_EQ(judged("forest.length_m=1000", {30, 0, 7}), Outcome::out_of_bounds);
  EXPECT_EQ(judged("forest.length_m=1000", {1016, 0, 4}), Outcome::goal);
}

TEST(Flight, ALongCourseIsLeftThroughTheAltitudesAlone) {
  FlightLog log;
  log.moments.resize(1);
  const auto left = [&](const char* length, const Eigen::Vector3d& place) {
    log.scenario = forest(1, {length});
    log.moments.back().T_world_body.translation() = place;
    return bound_left(log);
  };
  EXPECT_EQ(left("forest.length_m=60", {30, -40, 0.9}), "right");
  EXPECT_EQ(left("forest.length_m=60", {-40, 0, 4}), "back");
  EXPECT_EQ(left("forest.length_m=1000", {30, -40, 0.9}), "lower");
  EXPECT_EQ(left("forest.length_m=1000", {30, -40, 6.1}), "upper");
}

/// 540 trees, so those nearby alone stand in the model that is flown. They begin 15 m ahead.
TEST(Flight, OfALongCourseCountsFromTheFirstTree) {
  const auto of = [](const char* detector) {
    return forest(1000, {"forest.length_m=120", "forest.square_metres_per_tree=16",
                         std::string("perception.detector=") + detector});
  };
  const FlightResult arrived = Recorded(of("synthetic")).flown();
  EXPECT_EQ(arrived.outcome, Outcome::goal);
  EXPECT_NEAR(arrived.among_obstacles_m, 120, 1);
  Recorded blind(of("none"));
  const FlightResult lost = blind.flown();
  ASSERT_EQ(lost.outcome, Outcome::collision);
  EXPECT_NEAR(lost.among_obstacles_m, lost.progress_m - 15, 1);
  const FlightLog& log = blind.logger.log();
  const auto touched = std::ranges::find(log.obstacles, lost.touched, &Obstacle::name);
  ASSERT_NE(touched, log.obstacles.end()) << lost.touched;
  const Eigen::Vector3d place = log.moments.back().T_world_body.translation();
  EXPECT_LT((touched->from_world - place).head<2>().norm(), 1);
}

TEST(Flight, AnotherRendererBesideItIsRefusedInOneLine) {
  const Recorded drawing(forest(1000));
  try {
    const Flight other(forest(1000), {machine.models_folder, RendererKind::egl});
    FAIL() << "two GL libraries in one process";
  } catch (const std::runtime_error& error) {
    const std::string line = error.what();
    EXPECT_NE(line.find("already draws"), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
  }
}

/// Asks for everything at every event.
struct Asking : FlightObserver {
  bool needs_images() const override { return true; }
  void on_frame(const Flight& flight) override {
    ++frames;
    EXPECT_FALSE(flight.frame().left.empty());
    EXPECT_LE(flight.frame().t_ns, flight.clock().t_ns());
    EXPECT_LE(flight.truth_at(flight.frame().t_ns).t_ns, flight.frame().t_ns);
    flight.cameras()->depth(flight.truth_at(flight.frame().t_ns).T_world_body);
    flight.cameras()->chase_view(flight.truth(), 64, 48);
    hits += static_cast<std::int64_t>(flight.hits().size());
  }
  void on_step(const Flight& flight) override {
    ++steps;
    EXPECT_EQ(flight.truth().t_ns, flight.clock().t_ns());
    if (flight.clock().imu()) {
      EXPECT_EQ(flight.newest<ImuSample>().value().t_ns, flight.clock().t_ns());
      EXPECT_EQ(flight.state().t_ns, flight.clock().t_ns());
    }
    EXPECT_FALSE(flight.newest<GpsSample>());  // it has none
    EXPECT_FALSE(flight.outcome());
  }
  std::int64_t frames = 0, hits = 0, steps = 0;
};

TEST(Flight, ThatIsAskedForEverythingIsTheSame) {
  for (const char* detector : {"pushbroom", "true_depth"}) {
    const Scenario scenario =
        forest(1000, {"forest.length_m=4", std::string("perception.detector=") + detector});
    Asking asking;
    Recorded watched(scenario, {&asking});
    const FlightResult result = watched.flown();
    EXPECT_EQ(result.digest, Recorded(scenario).flown().digest) << detector;
    EXPECT_EQ(result.frames, asking.frames);
    EXPECT_EQ(result.detections, asking.hits);
    EXPECT_EQ(watched.flight.clock().step() + 1, asking.steps);
    watched.flight.step();  // it has ended: nothing happens
    EXPECT_EQ(watched.flight.clock().step() + 1, asking.steps);
  }
}

const std::vector<std::string> twenty_metres{"forest.length_m=20", "forest.square_metres_per_tree=25"};

// An airframe four metres long on a body of 0.4 m: its nose is in the pole behind the goal, and nothing was
// touched.
TEST(Flight, AClearanceBelowZeroWithoutAContactIsAContradiction) {
  std::vector<std::string> settings{
      "forest.length_m=10", "perception.detector=none",
      "obstacles=[{name: pole, shape: capsule, position_m: [27, 0, 5], size_m: [0.6, 0.6, 10]}]"};
  const auto result_of = [&] {
    return Recorded(load_scenario(root / "scenarios/library/clear.yaml", settings)).flown();
  };
  EXPECT_EQ(result_of().contradiction, "");
  settings.push_back("airframe.chord_m=2");
  const FlightResult result = result_of();
  EXPECT_EQ(result.outcome, Outcome::goal);
  EXPECT_LT(result.minimum_clearance_m, 0);
  EXPECT_NE(result.contradiction.find("nothing was touched"), std::string::npos) << result.contradiction;
  EXPECT_NE(to_report(result).find("contradiction"), std::string::npos);
}

TEST(Flight, ALongNameOfACountStandsApartFromItsNumber) {
  FlightResult result;
  result.planner.own.emplace_back("search_found_no_better", 8);
  EXPECT_NE(to_report(result).find("search found no better 8"), std::string::npos) << to_report(result);
}

TEST(Repeat, TheSameFlightTwiceIsTheSameToTheBit) {
  const Flown one = flown("forest", 1000, twenty_metres);
  const Flown other = flown("forest", 1000, twenty_metres);
  EXPECT_EQ(one.digest(), other.digest());  // every image, pose, estimate and control
  EXPECT_EQ(one.trajectory, other.trajectory);
  EXPECT_GT(one.result.at("frames"), 100);
  EXPECT_GT(one.detections(), 0);
}

TEST(Repeat, FullStereoOnABusyComputerIsTheSameToTheBit) {
  const auto busy = with(twenty_metres, {"perception.detector=stereo_bm", "perception.compute.enabled=true"});
  const Flown one = flown("forest", 1000, busy);
  const Flown other = flown("forest", 1000, busy);
  EXPECT_EQ(one.digest(), other.digest());
  EXPECT_EQ(one.trajectory, other.trajectory);
  EXPECT_GT(one.detections(), 0);
  // 8.3 times 9.0 ms each: the flight's length in frames, the one in work at the end apart.
  const double frames = one.result.at("simulated_s").get<double>() / (8.3 * 0.0090);
  EXPECT_NEAR(one.result.at("frames").get<double>(), frames, 1.2);
}

TEST(Repeat, AFlightThroughWoodsIsTheSameToTheBit) {
  const std::vector<std::string> short_woods{"forest.clear_m=8", "forest.length_m=8", "cameras.rate_hz=40"};
  const Flown one = flown("woods_dense", 1000, short_woods);
  const Flown other = flown("woods_dense", 1000, short_woods);
  EXPECT_EQ(one.digest(), other.digest());
  EXPECT_EQ(one.trajectory, other.trajectory);
  EXPECT_GT(one.detections(), 0);
}

/// A blind flight through low crowns: the time among leaves is counted, and ends the flight where a key says.
TEST(Leaves, AreCountedAndEndAFlightOnDemand) {
  const std::vector<std::string> harmless{"perception.detector=none", "cameras.rate_hz=1",
                                          "forest.square_metres_per_tree=16", "forest.intangible=true"};
  const Flown through = flown("woods_low", 1000, harmless);
  EXPECT_EQ(through.outcome(), "goal");
  const double leaves_s = through.result.at("leaves_s"), leaves_m = through.result.at("leaves_m");
  EXPECT_GT(leaves_s, 0.05);
  EXPECT_NEAR(leaves_m / leaves_s, through.result.at("mean_speed_mps").get<double>(), 1.5);
  const Flown ended = flown("woods_low", 1000, with(harmless, {"world.woods.leaves_end_flight=true"}));
  EXPECT_EQ(ended.outcome(), "collision");
  EXPECT_EQ(ended.result.at("touched"), "leaves");
  EXPECT_LT(ended.result.at("leaves_s").get<double>(), 0.01);
  EXPECT_EQ(flown("woods", 1000, with(harmless, {"world.woods.lowest_branch_m=12"})).result.at("leaves_s"),
            0);
}

TEST(Repeat, TheOtherLibraryDrawsTheSameFlight) {
  if (void* library = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL)) {
    dlclose(library);
  } else {
    GTEST_SKIP() << "no libEGL.so.1 here (Debian's libegl1)";
  }
  if (has_gpu_device_file()) GTEST_SKIP() << "a GPU is here, and EGL draws on it";
  const Flown osmesa = flown("forest", 1000, twenty_metres, "--renderer osmesa");
  const Flown egl = flown("forest", 1000, twenty_metres, "--renderer egl");
  EXPECT_EQ(osmesa.digest(), egl.digest());
  EXPECT_NE(std::string(egl.result.at("renderer")).find("llvmpipe"), std::string::npos);
}

TEST(Repeat, AnotherSensorSeedIsAnotherFlightThroughTheSameForest) {
  const Flown one = flown("forest", 1000, with(twenty_metres, {"sensors.seed=1"}));
  const Flown other = flown("forest", 1000, with(twenty_metres, {"sensors.seed=2"}));
  EXPECT_NE(one.digest(), other.digest());
  EXPECT_NE(one.trajectory, other.trajectory);
  // On the rail nothing has been decided yet, and the forest is the same: so is the first distance to it.
  EXPECT_EQ(columns(one, {"x_m", "z_m", "clearance_m"}).front(),
            columns(other, {"x_m", "z_m", "clearance_m"}).front());
}

TEST(Repeat, AnotherSeedIsAnotherForest) {
  const Flown one = flown("forest", 1000, with(twenty_metres, {"cameras.rate_hz=1"}));
  const Flown other = flown("forest", 1001, with(twenty_metres, {"cameras.rate_hz=1"}));
  EXPECT_NE(columns(one, {"clearance_m"}).front(), columns(other, {"clearance_m"}).front());
}

}  // namespace
}  // namespace understory
