#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <sstream>

#include "scenarios/flight/clearance.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/flight_arrays.hpp"
#include "scenarios/flight/flight_logger.hpp"
#include "scenarios/flight/flight_page.hpp"
#include "scenarios/flight/flight_story.hpp"
#include "scenarios/flight/obstacle_view.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "tests/closed_loop/flown.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// What people look at after a flight, against the flight itself.
namespace understory {
namespace {

namespace fs = std::filesystem;
using support::expect_part;
using support::TemporaryFolder;

Scenario library(const std::string& name, const std::vector<std::string>& settings) {
  return load_scenario(root / "scenarios/library" / (name + ".yaml"), settings);
}

/// A flight that ended, its log and its story.
struct Told {
  explicit Told(const Scenario& scenario) : flight(scenario, {root / "models"}, {&logger}) {
    while (!flight.outcome()) flight.step();
    story = story_of(log());
  }
  const FlightLog& log() const { return logger.log(); }
  FlightLogger logger;
  Flight flight;
  FlightStory story;

  const FlightEvent* event(const std::string& kind) const {
    const auto found = std::ranges::find(story.events, kind, &FlightEvent::kind);
    return found == story.events.end() ? nullptr : &*found;
  }
};

/// The aircraft sees nothing and flies into what stands in the way; it sees, with the planner's reach cut.
const std::vector<std::string> unseeing{"seed=1000", "perception.detector=none"};

TEST(FlightStory, NamesTrunkPartAndPlaceOfACollision) {
  const Told told(library("dense", unseeing));
  ASSERT_EQ(told.log().result.outcome, Outcome::collision);
  ASSERT_TRUE(told.story.touched);
  const Obstacle& touched = told.flight.obstacles()[told.story.touched->obstacle];
  EXPECT_EQ(touched.name, told.log().result.touched);
  expect_part(told.story.outcome, touched.name);
  expect_part(told.story.outcome, fmt::format("{:.2f} s", told.flight.clock().t_s()));
  // The place lies on the trunk and on the part that is named, but for the step that MuJoCo allows.
  const Touch& touch = told.log().touch;
  ASSERT_EQ(touch.with, Contact::obstacle);
  const Eigen::Vector3d impact_world = touch.position_world;
  EXPECT_NEAR(obstacle_distance_m({impact_world, impact_world}, touched), 0, 0.02);
  const Eigen::Vector3d impact_body = told.flight.truth().T_world_body.inverse() * impact_world;
  const auto parts = told.flight.aircraft_shape().parts;
  const auto part = std::ranges::find(parts, touch.part, &AircraftPart::name);
  ASSERT_NE(part, parts.end());
  EXPECT_TRUE(((impact_body - part->centre_body).cwiseAbs() - part->half_size_m).maxCoeff() < 0.02)
      << touch.part;
  EXPECT_EQ(told.event("detected"), nullptr);  // it was blind
}

/// The number before a word of a sentence: "0.21 m left of" gives 0.21 for "m left of"; 0 without it.
double number_before(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(" " + words);
  if (at == std::string::npos) return 0;
  const std::size_t begin = text.find_last_of(" ;", at - 1) + 1;
  return std::stod(text.substr(begin, at - begin));
}

/// A planner that may only just touch flies into a tree that it has seen.
const std::vector<std::string> careless{"seed=1000", "autopilot.planner.field.half_span_m=0.01",
                                        "autopilot.planner.trajectory.minimum_clearance_m=0.01",
                                        "autopilot.planner.trajectory.comfortable_clearance_m=0.1"};

TEST(FlightStory, TellsWhenTheTrunkWasSeen) {
  const Told told(library("dense", careless));
  ASSERT_EQ(told.log().result.outcome, Outcome::collision);
  const FlightEvent *seen = told.event("in_view"), *detected = told.event("detected"),
                    *end = told.event("outcome");
  ASSERT_TRUE(seen != nullptr && detected != nullptr && end != nullptr);
  EXPECT_LE(seen->t_s, detected->t_s);
  EXPECT_LT(detected->t_s, end->t_s);
  EXPECT_TRUE(std::ranges::is_sorted(told.story.events, {}, &FlightEvent::t_s));
  // The renderer's own image of objects says the same.
  const std::size_t touched = told.story.touched->obstacle;
  const auto drawn_px = [&](const LogFrame& frame) {
    const TrueView view = told.flight.cameras()->true_view(frame.T_world_body);
    return cv::countNonZero(view.objects == static_cast<double>(object_first_obstacle + touched));
  };
  const auto first =
      std::ranges::find_if(told.log().frames, [&](const LogFrame& frame) { return drawn_px(frame) >= 25; });
  ASSERT_NE(first, told.log().frames.end());
  EXPECT_NEAR(seconds(first->t_ns), seen->t_s, 0.05);
  const LogFrame& last = told.log().frames.back();
  EXPECT_NEAR(pixels_in_view(told.log(), last.t_ns, last.T_world_body, touched, 1 << 30), drawn_px(last),
              0.03 * drawn_px(last) + 20);
}

TEST(FlightStory, SaysWhereTheObstacleWasRemembered) {
  const Told told(library("dense", careless));
  ASSERT_TRUE(told.story.touched);
  const Obstacle& trunk = told.log().obstacles[told.story.touched->obstacle];
  // The map's own points, placed beside the aircraft as the estimate has them.
  const Eigen::Isometry3d T_world_odometry =
      told.flight.truth().T_world_body * told.flight.state().T_world_body.inverse();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int points = 0;
  for (const ObstaclePoint& point : told.flight.map().points()) {
    const Eigen::Vector3d place = T_world_odometry * point.position_world;
    if ((place - trunk.from_world).head<2>().norm() - trunk.radius_m > 1) continue;
    sum += (place - trunk.from_world).head<2>();
    ++points;
  }
  ASSERT_GT(points, 0);
  const auto sentence = std::ranges::find_if(told.story.before, [](const std::string& text) {
    return text.find("the map held") != std::string::npos;
  });
  ASSERT_NE(sentence, told.story.before.end());
  EXPECT_EQ(number_before(*sentence, "points within"), points);
  EXPECT_NEAR(number_before(*sentence, "m left of") - number_before(*sentence, "m right of"),
              sum.y() / points, 0.006);
  EXPECT_NEAR(number_before(*sentence, "m behind") - number_before(*sentence, "m in front of"),
              sum.x() / points, 0.006);
}

/// A log that holds one obstacle, hit at the end, and points remembered for it.
FlightLog log_of(const Obstacle& obstacle, const std::vector<Eigen::Vector3d>& remembered) {
  FlightLog log;
  log.obstacles = {obstacle};
  log.moments.resize(1);
  log.moments[0].T_world_body.translation() = Eigen::Vector3d(9, 0, 3);
  log.moments[0].T_odometry_body = log.moments[0].T_world_body;
  log.result.outcome = Outcome::collision;
  log.result.touched = obstacle.name;
  log.touch = {Contact::obstacle, "fuselage", {10, 0, 3}};
  for (const Eigen::Vector3d& place : remembered) {
    LogPoint& one = log.points.emplace_back();
    one.point.position_world = one.true_position_world = place;
  }
  return log;
}

TEST(FlightStory, MeasuresFromTheNearestPlaceOfAnyShape) {
  struct Case {
    ObstacleKind kind;
    Eigen::Vector3d from, to, remembered;
    double left_m, behind_m, above_m;
  };
  for (const Case& one : {Case{ObstacleKind::rail, {10, -15, 3}, {10, 15, 3}, {9.7, 4, 3.2}, 0, -0.3, 0.2},
                          Case{ObstacleKind::crossbar, {10, -3, 3}, {10, 3, 3}, {10.4, -1, 3}, 0, 0.4, 0},
                          Case{ObstacleKind::wall, {10, -30, 0}, {10, 30, 20}, {9.75, 12, 7}, 0, -0.25, 0},
                          Case{ObstacleKind::trunk, {10, 0, 0}, {10, 0, 9}, {10.1, -0.3, 5}, -0.3, 0.1, 0}}) {
    Obstacle obstacle{"it", one.from, one.to, 0.05};
    obstacle.kind = one.kind;
    const FlightStory story = story_of(log_of(obstacle, {one.remembered}));
    const std::string& text = story.before.at(1);
    EXPECT_NEAR(number_before(text, "m left of") - number_before(text, "m right of"), one.left_m, 0.006)
        << text;
    EXPECT_NEAR(number_before(text, "m behind") - number_before(text, "m in front of"), one.behind_m, 0.006)
        << text;
    EXPECT_NEAR(number_before(text, "m above") - number_before(text, "m below"), one.above_m, 0.006) << text;
  }
}

TEST(FlightStory, SaysWhichBoundWasLeftAndByHowMuch) {
  const Told told(
      library("clear", {"seed=1000", "band.maximum_altitude_m=2.2", "band.cruise_altitude_m=2.1"}));
  ASSERT_EQ(told.log().result.outcome, Outcome::out_of_bounds);
  expect_part(told.story.outcome, "upper bound of 2.2 m");
  EXPECT_NEAR(number_before(told.story.outcome, "m at"), told.flight.truth().T_world_body.translation().z(),
              0.006);
}

TEST(FlightLog, IsTheFlight) {
  const Told told(library("forest", {"seed=1000", "forest.length_m=12"}));
  const FlightLog& log = told.log();
  ASSERT_GT(log.moments.size(), 100u);
  EXPECT_EQ(log.moments.back().t_ns, told.flight.clock().t_ns());
  EXPECT_TRUE(log.moments.back().T_world_body.isApprox(told.flight.truth().T_world_body));
  EXPECT_EQ(static_cast<std::int64_t>(log.hits_camera.size()), log.result.detections);
  EXPECT_EQ(log.frames.back().first_hit + log.frames.back().hits, log.result.detections);
  // What the map holds at the end, in its order, is what the log holds then.
  std::vector<Eigen::Vector3d> remembered;
  for (const LogPoint& one : log.points)
    if (one.to_ns == still_there_ns) remembered.push_back(one.point.position_world);
  const std::vector<ObstaclePoint>& map = told.flight.map().points();
  ASSERT_EQ(remembered.size(), map.size());
  for (const ObstaclePoint& point : map)
    EXPECT_TRUE(std::ranges::count(remembered, point.position_world) > 0);
  for (const LogPoint& one : log.points) ASSERT_LT(one.from_ns, one.to_ns);
  ASSERT_FALSE(log.plans.empty());
  EXPECT_EQ(log.plans.back().way_odometry.size(), told.flight.plan().points.size());
}

TEST(FlightLog, IsReadBackAsItWasWritten) {
  const Told told(library("goalposts", {"seed=1000", "forest.length_m=30"}));
  const FlightLog& log = told.log();
  const std::string bytes = to_bytes(log);
  const FlightLog read = flight_log_from_bytes(bytes, "flight.log", root / "models");
  ASSERT_EQ(read.moments.size(), log.moments.size());
  for (std::size_t i = 0; i < log.moments.size(); ++i) {
    EXPECT_EQ(read.moments[i].t_ns, log.moments[i].t_ns);
    EXPECT_LT((read.moments[i].T_world_body.translation() - log.moments[i].T_world_body.translation()).norm(),
              1e-4);
    EXPECT_TRUE(
        read.moments[i].T_odometry_body.linear().isApprox(log.moments[i].T_odometry_body.linear(), 1e-5));
    EXPECT_NEAR(read.moments[i].controls.left_elevon_rad, log.moments[i].controls.left_elevon_rad, 1e-5);
  }
  ASSERT_EQ(read.points.size(), log.points.size());
  EXPECT_EQ(read.points.back().to_ns, log.points.back().to_ns);
  ASSERT_EQ(read.plans.size(), log.plans.size());
  EXPECT_EQ(read.plans.back().way_odometry.size(), log.plans.back().way_odometry.size());
  EXPECT_EQ(std::isfinite(read.plans.front().clearance_m), std::isfinite(log.plans.front().clearance_m));
  EXPECT_EQ(read.obstacles.back().kind, ObstacleKind::crossbar);
  EXPECT_EQ(read.result.digest, log.result.digest);
  EXPECT_EQ(read.result.points_on_obstacles, log.result.points_on_obstacles);
  EXPECT_EQ(read.result.planner.own, log.result.planner.own);
  EXPECT_EQ(scenario_to_text(read.scenario), scenario_to_text(log.scenario));
  EXPECT_EQ(story_of(read).outcome, told.story.outcome);
  // Any damage is refused, or does no harm.
  const auto is_refused = [&](const std::string& damaged) {
    try {
      flight_log_from_bytes(damaged, "flight.log", root / "models");
    } catch (const ScenarioError&) {
      return true;
    }
    return false;
  };
  EXPECT_TRUE(is_refused(""));
  EXPECT_TRUE(is_refused("understory flight log\n"));
  for (std::size_t length = 0; length < bytes.size(); length += bytes.size() / 50)
    EXPECT_TRUE(is_refused(bytes.substr(0, length)));
  std::string damaged = bytes;
  for (std::size_t at = 30; at < bytes.size(); at += bytes.size() / 100) {
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    is_refused(damaged);
    damaged[at] = bytes[at];
  }
}

/// Kinds and ends of what a page draws, from the page itself.
TEST(FlightPage, DrawsEveryCoursesObstaclesAsTheyAre) {
  for (const char* course : {"forest", "goalposts", "windows", "fence", "clear"}) {
    const Told told(library(course, {"seed=1000", "time_limit_s=0.3", "perception.detector=none"}));
    nlohmann::ordered_json facts;
    PageArrays arrays;
    add_flight(told.log(), told.story, PageDetail::everything, arrays, facts);
    const auto table = nlohmann::json::parse(arrays.table());
    const auto kinds =
        std::ranges::find(table, "obstacle_kinds", [](const auto& one) { return one.at("name"); });
    ASSERT_NE(kinds, table.end());
    ASSERT_EQ(kinds->at("count"), told.log().obstacles.size()) << course;
    for (std::size_t i = 0; i < told.log().obstacles.size(); ++i) {
      const auto number =
          static_cast<unsigned char>(arrays.bytes().at(kinds->at("offset").get<std::size_t>() + i));
      EXPECT_EQ(facts.at("obstacle_kinds").at(number), word_for(told.log().obstacles[i].kind)) << course;
    }
  }
}

TEST(FlightPage, SaysHowFarTheDetectorLooks) {
  const auto page = [](const std::string& setting) {
    return flight_page(Told(library("forest", {"time_limit_s=0.1", setting})).log(), {root});
  };
  expect_part(page("seed=1000"), "pushbroom at 10.1 m");
  expect_part(page("perception.depths_m=[10, 7]"), "pushbroom at 10.0, 7.0 m");
  expect_part(page("perception.detector=stereo_bm"), "stereo_bm from 1.5 to 15.0 m");
  const Told exact(library("paper_depths", {"time_limit_s=0.1", "perception.detector=true_depth"}));
  expect_part(flight_page(exact.log(), {root}), "true_depth at 12.0, 9.1, 6.4, 4.8 m");
}

// ---- the commands ----

class ReportCommand : public testing::Test {
 protected:
  support::ProgramRun here(const std::string& arguments) const {
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
  const support::ProgramRun outcome = here("report run --no-video");
  EXPECT_EQ(outcome.status, 0);
  expect_part(outcome.text, "made of the run's log");
  EXPECT_EQ(file("run/result.json"), before);
  const std::string page = file("run/report.html");
  expect_part(page, nlohmann::json::parse(before).at("digest").get<std::string>());
  EXPECT_LT(page.size(), 3'000'000u);
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
  const support::ProgramRun outcome = here("report run --no-video");
  EXPECT_EQ(outcome.status, 1);
  expect_part(outcome.text, "another digest");
  expect_part(file("run/report.html"), "This page shows another flight");
}

TEST_F(ReportCommand, SaysThatAnOlderRunMustBeFlownAgain) {
  fly_briefly();
  fs::remove(folder.path() / "run/flight.log");
  refused("report run --no-video", "written by an older version; fly it again");
  refused("mcap run --no-images", "written by an older version; fly it again");
}

TEST_F(ReportCommand, TakesARunWithoutAResultAndRefusesWhatIsNoRun) {
  fly_briefly();
  fs::remove(folder.path() / "run/result.json");
  fs::remove(folder.path() / "run/trajectory.csv");
  EXPECT_EQ(here("report run --no-video --out page.html").status, 0);
  expect_part(file("page.html"), "id=\"facts\"");
  folder.write("run/result.json", "{");
  refused("report run", "run/result.json: not a flight's result");
  refused("report nowhere", "nowhere: neither the folder of a run");
  refused("mcap nowhere", "nowhere: neither the folder of a run");
  fs::remove(folder.path() / "run/scenario.yaml");
  refused("report run", "run: neither the folder of a run");
}

TEST_F(ReportCommand, KeepsWhatLogsAndPathsSay) {
  fly_briefly();
  EXPECT_EQ(here("mcap run --no-images").status, 0);
  EXPECT_EQ(file("run/flight.mcap").substr(1, 4), "MCAP");
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
