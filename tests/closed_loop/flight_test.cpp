#include "scenarios/flight/flight.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "scenarios/flight/run_record.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "tests/closed_loop/flown.hpp"

/// The flight as an object, against the program's flights in processes of their own.
namespace understory {
namespace {

const std::filesystem::path root = UNDERSTORY_SOURCE_DIR;
const FlightMachine machine{root / "models"};
const std::vector<std::string> short_forest{"forest.length_m=12", "forest.square_metres_per_tree=16"};

Scenario forest(int seed, std::vector<std::string> settings = short_forest) {
  settings.push_back("seed=" + std::to_string(seed));
  return load_scenario(root / "scenarios/library/forest.yaml", settings);
}

/// A flight and its record.
struct Recorded {
  explicit Recorded(const Scenario& scenario, std::vector<FlightObserver*> more = {})
      : flight(scenario, machine, with_record(std::move(more))) {}
  std::vector<FlightObserver*> with_record(std::vector<FlightObserver*> observers) {
    observers.push_back(&record);
    return observers;
  }
  FlightResult flown() {
    while (!flight.ending()) flight.step();
    return record.finish(flight);
  }

  RunRecord record;
  Flight flight;
};

TEST(Flight, TheSecondOfAProcessIsAsInAFreshOne) {
  Recorded(forest(1000)).flown();
  const FlightResult second = Recorded(forest(1001)).flown();
  EXPECT_GT(second.planner.searches, 0);  // OMPL was asked, in both
  EXPECT_EQ(second.digest, flown("forest", 1001, short_forest).digest());
}

TEST(Flight, TwoOpenAtOnceAreAsAlone) {
  Recorded one(forest(1000)), other(forest(1001));
  while (!one.flight.ending() || !other.flight.ending()) {
    one.flight.step();
    other.flight.step();
  }
  EXPECT_EQ(one.flown().digest, flown("forest", 1000, short_forest).digest());
  EXPECT_EQ(other.flown().digest, flown("forest", 1001, short_forest).digest());
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
    flight.chase_view(64, 48);
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
    EXPECT_FALSE(flight.ending());
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

}  // namespace
}  // namespace understory
