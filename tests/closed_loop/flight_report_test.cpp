#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "scenarios/flight/clearance.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/flight_page.hpp"
#include "scenarios/flight/flight_story.hpp"
#include "scenarios/flight/flight_track.hpp"
#include "scenarios/flight/flight_logger.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// What people look at after a flight, against the flight itself.
namespace understory {
namespace {

namespace fs = std::filesystem;
using support::expect_part;
using support::TemporaryFolder;

const fs::path root = UNDERSTORY_SOURCE_DIR;

Scenario library(const std::string& name, const std::vector<std::string>& settings) {
  return load_scenario(root / "scenarios/library" / (name + ".yaml"), settings);
}

/// A flight that ended, its track and its story.
struct Told {
  explicit Told(const Scenario& scenario) : flight(scenario, {root / "models"}, {&logger, &recorder}) {
    while (!flight.outcome()) flight.step();
    result = logger.log().result;
    track = recorder.finish(flight);
    story = story_of(flight, track);
  }
  FlightLogger logger;
  TrackRecorder recorder;
  Flight flight;
  FlightResult result;
  FlightTrack track;
  FlightStory story;

  const FlightEvent* event(const std::string& kind) const {
    const auto found = std::ranges::find(story.events, kind, &FlightEvent::kind);
    return found == story.events.end() ? nullptr : &*found;
  }
};

/// The aircraft sees nothing and flies into what stands in the way; it sees, with the planner's reach cut.
const std::vector<std::string> blind{"seed=1000", "perception.detector=none"};

TEST(FlightStory, NamesTrunkPartAndPlaceOfACollision) {
  const Told told(library("dense", blind));
  ASSERT_EQ(told.result.outcome, Outcome::collision);
  ASSERT_TRUE(told.story.touched);
  const Obstacle& touched = told.flight.obstacles()[*told.story.touched];
  EXPECT_EQ(touched.name, told.result.touched);
  expect_part(told.story.outcome, touched.name);
  expect_part(told.story.outcome, fmt::format("{:.2f} s", told.flight.clock().t_s()));
  // The place lies on the trunk and on the part that is named, but for the step that MuJoCo allows.
  ASSERT_TRUE(told.story.impact_world);
  const Eigen::Vector3d impact_world = *told.story.impact_world;
  EXPECT_NEAR(obstacle_distance_m({impact_world, impact_world}, touched), 0, 0.02);
  const Eigen::Vector3d impact_body = told.flight.truth().T_world_body.inverse() * impact_world;
  const auto parts = told.flight.aircraft_shape().parts;
  const auto part = std::ranges::find(parts, told.story.part, &AircraftPart::name);
  ASSERT_NE(part, parts.end());
  EXPECT_TRUE(((impact_body - part->centre_body).cwiseAbs() - part->half_size_m).maxCoeff() < 0.02)
      << told.story.part;
  EXPECT_EQ(told.event("detected"), nullptr);  // it was blind
}

TEST(FlightStory, TellsWhenTheTrunkWasSeenAndWhereItWasRemembered) {
  // A planner that may only just touch: it flies into a tree that it has seen.
  const Told told(library("dense", {"seed=1005", "autopilot.planner.field.half_span_m=0.01",
                                    "autopilot.planner.trajectory.minimum_clearance_m=0.01"}));
  ASSERT_EQ(told.result.outcome, Outcome::collision);
  const FlightEvent *seen = told.event("in_view"), *detected = told.event("detected"),
                    *end = told.event("outcome");
  ASSERT_TRUE(seen != nullptr && detected != nullptr && end != nullptr);
  EXPECT_LE(seen->t_s, detected->t_s);
  EXPECT_LT(detected->t_s, end->t_s);
  EXPECT_TRUE(std::ranges::is_sorted(told.story.events, {}, &FlightEvent::t_s));
}

TEST(FlightStory, SaysWhichBoundWasLeftAndByHowMuch) {
  const Told told(
      library("clear", {"seed=1000", "band.maximum_altitude_m=2.2", "band.cruise_altitude_m=2.1"}));
  ASSERT_EQ(told.result.outcome, Outcome::out_of_bounds);
  expect_part(told.story.outcome, "upper bound of 2.2 m");
  expect_part(told.story.outcome,
              fmt::format("{:.2f} m", told.flight.truth().T_world_body.translation().z()));
}

TEST(FlightTrack, IsTheFlight) {
  const Told told(library("forest", {"seed=1000", "forest.length_m=12"}));
  const FlightTrack& track = told.track;
  ASSERT_GT(track.moments.size(), 100u);
  EXPECT_EQ(track.moments.back().t_s, told.flight.clock().t_s());
  EXPECT_TRUE(track.moments.back().T_world_true.isApprox(told.flight.truth().T_world_body));
  EXPECT_EQ(static_cast<std::int64_t>(track.frames.size()), told.result.frames);
  EXPECT_EQ(static_cast<std::int64_t>(track.hits_world.size()), told.result.detections);
  EXPECT_EQ(track.frames.back().first_hit + track.frames.back().hits, track.hits_world.size());
  // What the map holds at the end is what the track holds then.
  const double end_s = told.flight.clock().t_s();
  const auto remembered =
      std::ranges::count_if(track.points, [&](const TrackPoint& point) { return point.to_s == end_s; });
  EXPECT_EQ(remembered, static_cast<std::ptrdiff_t>(told.flight.map().points().size()));
  for (const TrackPoint& point : track.points) ASSERT_LE(point.from_s, point.to_s);
  ASSERT_FALSE(track.plans.empty());
  EXPECT_EQ(track.plans.back().way_world.size(), told.flight.plan().points.size());
}

// ---- the commands ----

class ReportCommand : public testing::Test {
 protected:
  support::Outcome here(const std::string& arguments) const {
    return support::understory(arguments, "cd " + folder.path().string() + " &&");
  }
  void refused(const std::string& arguments, const std::string& part) const {
    support::expect_refusal(arguments, part, 2, "cd " + folder.path().string() + " &&");
  }
  void fly_briefly() const {
    EXPECT_EQ(here("fly forest --seed 1000 --set time_limit_s=1 --out run").status, 1);
  }
  std::string file(const std::string& name) const {
    std::stringstream text;
    text << std::ifstream(folder.path() / name, std::ios::binary).rdbuf();
    return text.str();
  }
  const TemporaryFolder folder;
};

TEST_F(ReportCommand, MakesAPageFromARunAndLeavesTheRest) {
  fly_briefly();
  const std::string before = file("run/result.json");
  const support::Outcome outcome = here("report run --no-video");
  EXPECT_EQ(outcome.status, 0);
  expect_part(outcome.text, "flown again, with the run's digest");
  EXPECT_EQ(file("run/result.json"), before);
  const std::string page = file("run/report.html");
  expect_part(page, nlohmann::json::parse(before).at("digest").get<std::string>());
  EXPECT_LT(page.size(), 3'000'000u);
  EXPECT_FALSE(fs::exists(folder.path() / "run/report.html.part"));
}

TEST_F(ReportCommand, GivesACommandThatFliesTheSameScenario) {
  for (const std::vector<std::string>& settings :
       std::vector<std::vector<std::string>>{{"seed=7"},
                                             {"perception.preset=original", "forest.length_m=30"},
                                             {"sensors.grade=rough", "perception.depths_m=[5, 9]"}}) {
    std::vector<std::string> brief = settings;
    brief.push_back("time_limit_s=0.1");
    const Scenario scenario = library("forest", brief);
    const std::string arguments = arguments_that_fly(scenario, root);
    expect_part(arguments, fmt::format("forest --seed {}", scenario.seed));
    EXPECT_EQ(here("fly " + arguments + " --out again --force").status, 1) << arguments;
    EXPECT_EQ(file("again/scenario.yaml"), scenario_to_text(scenario)) << arguments;
  }
  Scenario other = library("forest", {});
  other.name = "mine";
  EXPECT_EQ(arguments_that_fly(other, root), "scenario.yaml");
}

TEST_F(ReportCommand, WarnsWhereTheFlightIsAnother) {
  fly_briefly();
  folder.write("run/result.json", R"({"digest": "0123456789abcdef"})");
  const support::Outcome outcome = here("report run --no-video");
  EXPECT_EQ(outcome.status, 1);
  expect_part(outcome.text, "another digest");
  expect_part(file("run/report.html"), "This page shows another flight");
}

TEST_F(ReportCommand, TakesARunWithoutAResultAndRefusesWhatIsNoRun) {
  fly_briefly();
  fs::remove(folder.path() / "run/result.json");
  fs::remove(folder.path() / "run/trajectory.csv");
  EXPECT_EQ(here("report run --no-video --out page.html").status, 0);
  expect_part(file("page.html"), "id=\"facts\"");
  folder.write("run/result.json", "{");
  refused("report run", "run/result.json: expected");
  refused("report nowhere", "nowhere: expected the folder of a run");
  refused("mcap nowhere", "nowhere: expected the folder of a run");
  fs::remove(folder.path() / "run/scenario.yaml");
  refused("report run", "run: expected the folder of a run");
}

TEST_F(ReportCommand, KeepsWhatLogsAndPathsSay) {
  fly_briefly();
  EXPECT_EQ(here("mcap run").status, 0);
  EXPECT_EQ(file("run/flight.mcap").substr(1, 4), "MCAP");
  // As many poses as rows, and a row's position in them.
  const std::string csv = file("run/trajectory.csv"), tum = file("run/truth.tum");
  EXPECT_EQ(std::ranges::count(csv, '\n'), std::ranges::count(tum, '\n') + 1);
  EXPECT_EQ(std::ranges::count(tum, '\n'), std::ranges::count(file("run/estimate.tum"), '\n'));
  // One obstacle a line.
  expect_part(file("run/obstacles.csv"), "name,kind,from_x_m");
}

}  // namespace
}  // namespace understory
