#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/campaign/flight_row.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/config/keys.hpp"
#include "scenarios/flight/flight_result.hpp"
#include "scenarios/parts/parts.hpp"
#include "scenarios/report/table.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

struct KeysArguments {
  std::string scenario, against;
  bool json = false, markdown = false;
};

std::vector<Key> result_keys() {
  std::vector<Key> keys;
  const auto add = [&](std::string_view name, const auto&, std::string_view meaning) {
    keys.push_back(key_of(name, meaning));
  };
  const FlightResult result;
  visit_fields(add, result);
  add("points_on_obstacles", 0,
      "Number of points added to the map within 0.5 m of each obstacle, by its name; only on courses of at "
      "most eight obstacles.");
  add("planner_counts", 0, "counts that one planner alone knows, by name");
  add("timings", 0, "wall time of each stage of the simulation: count, mean, maximum and total");
  return keys;
}

Table table_of(const std::vector<Key>& keys, bool are_columns) {
  Table table{are_columns ? std::vector<std::string>{"Column", "Unit", "Meaning"}
                          : std::vector<std::string>{"Key", "Default", "Unit", "Range", "Meaning", "Source"}};
  for (const Key& key : keys) {
    if (are_columns)
      table.rows.push_back({key.name, key.unit, key.meaning});
    else
      table.rows.push_back({key.name, key.value, key.unit, key.range, key.meaning, key.source});
  }
  return table;
}

/// A part of the list of keys: those that begin with `prefix` and with no longer one.
struct Chapter {
  std::string prefix, title, text;
};
const std::vector<Chapter> written_chapters{
    {"", "The flight", "What is flown: course, seed and rig. Every other group describes a part of it."},
    {"wind", "Wind",
     "The mean wind, its profile over height, turbulence, one gust, and the shelter of the forest. Still air "
     "is the default."},
    {"band.", "Altitudes",
     "The altitudes within which a flight must stay. A flight over the trees or along the ground would prove "
     "nothing."},
    {"forest.", "Course: forest",
     "A forest: trunks placed at random from the seed, or measured ones. Its length also sets the goal plane "
     "of the other courses. x points ahead from the launch, y to the left."},
    {"goalposts.", "Course: goalposts",
     "The field goal of Barry & Tedrake 2015, which is passed beside an upright."},
    {"windows.", "Course: windows",
     "A facade of equal windows behind the goal: repeated texture for `evaluate`."},
    {"fence.", "Course: fence",
     "Fences of equal palings along and across the course: repeated shapes for `evaluate`."},
    {"obstacles[", "Obstacles of the scenario's own",
     "A list of boxes, capsules and spheres that stand on any course beside what the course has."},
    {"launch.", "Launch", "The catapult: the aircraft rests on its rail, is accelerated, and is released."},
    {"airframe.", "Airframe",
     "The delta wing's identified flat-plate model. The simulator, the planner and the filter use it. Axes: "
     "x forward, y left, z up, from the centre of mass. All defaults come from the original's flight "
     "records."},
    {"mismatch.", "Mismatch",
     "Differences between the aircraft that flies and the airframe that the stack believes in, in percent."},
    {"actuators.", "Actuators",
     "Lags and limits of servos, motor and propeller. The identified model has none, so each is off by "
     "default."},
    {"world.", "World", "The appearance of the scene."},
    {"world.woods.", "World: woods",
     "The appearance of woods (docs/woods.md). A key that keeps its default is drawn from the scenario's "
     "seed, except leaves_end_flight."},
    {"cameras.", "Cameras", "What the stereo cameras do to the images (docs/cameras.md)."},
    {"sensors.", "Sensors",
     "Errors and rates of the other sensors (docs/sensors.md). A grade sets them together. The standard "
     "deviation of a constant error is that over flights: each flight draws one."},
    {"faults[", "Faults",
     "A list of failures; each entry names a sensor, a kind and a time (docs/sensors.md)."},
    {"perception.", "Detection", "Which detector flies, and from which parameters it starts."},
    {"perception.pushbroom.", "Detection: pushbroom",
     "The detector of Barry & Tedrake 2015: blocks of 5x5 pixels that match at one depth. The presets of "
     "perception.preset set these keys."},
    {"perception.stereo_bm.", "Detection: StereoBM",
     "OpenCV's block matching, with the settings of the paper's evaluation."},
    {"perception.stereo_sgbm.", "Detection: StereoSGBM",
     "OpenCV's semi-global matching (Hirschmueller 2008)."},
    {"perception.full_stereo.", "Detection: full stereo",
     "Which pixels of StereoBM's and StereoSGBM's depth images become detections."},
    {"perception.compute.", "Detection: the computer",
     "A simulated computer that is busy with each pair for a stated time (docs/thesis.md)."},
    {"estimation.", "Estimation", "Which state the stack believes in: the filter's, or the truth."},
    {"estimation.dead_reckoning.", "Estimation: dead reckoning",
     "The state from pitot and gyro alone (estimation.source: dead_reckoning)."},
    {"estimation.filter.", "Estimation: filter",
     "The error-state Kalman filter (docs/estimator.md). Standard deviations are one sigma. The scenario "
     "sets start, airframe and the sensors' noises from its other groups; keys given here win."},
    {"autopilot.", "Autopilot", "When the aircraft takes control, and how often it plans."},
    {"autopilot.map.", "Autopilot: map", "Which detections the map remembers, and for how long."},
    {"autopilot.resightings.", "Autopilot: resightings",
     "How two sightings of one obstacle, at a far and at a near depth, measure the velocity over ground."},
    {"autopilot.flight_model.", "Autopilot: flight model",
     "How the aircraft answers commands, as the planner predicts it and the path follower commands it."},
    {"autopilot.planner.", "Autopilot: planner", "When a plan is kept, and when a new one replaces it."},
    {"autopilot.planner.field.", "Planner: obstacle field",
     "How remembered points become columns with a size."},
    {"autopilot.planner.trajectory.", "Planner: trajectory",
     "Limits and costs of a trajectory. Costs are dimensionless, per second of flight; the cheapest wins."},
    {"autopilot.planner.search.", "Planner: search",
     "The tree of manoeuvres that OMPL grows where autopilot.method is sst (Li, Littlefield & Bekris 2016), "
     "rrt or est. A manoeuvre is a row of commands, each a bank and a climb for a time."},
    {"autopilot.library.", "Planner: library",
     "The planner that chooses from a list of manoeuvres (autopilot.method: library)."},
    {"autopilot.planner.improvement.", "Planner: improvement",
     "Random changes that make the manoeuvre found cheaper."},
    {"autopilot.follower.", "Autopilot: path follower",
     "The inner loops that turn commands into elevons and thrust."}};

/// Of a part with keys of its own about which nothing is written: its meaning.
template <typename One>
void add_chapters(std::vector<Chapter>& chapters, const PartList<One>& list, const std::string& above,
                  const std::string& kind) {
  for (const One& part : list.all()) {
    const std::string prefix = above + part.name + ".";
    if (part.defaults && std::ranges::find(chapters, prefix, &Chapter::prefix) == chapters.end())
      chapters.push_back({prefix, kind + ": " + part.name, part.meaning + "."});
  }
}

std::vector<Chapter> all_chapters() {
  std::vector<Chapter> chapters = written_chapters;
  add_chapters(chapters, parts().detectors, "perception.", "Detection");
  add_chapters(chapters, parts().state_sources, "estimation.", "Estimation");
  add_chapters(chapters, parts().planners, "autopilot.", "Planner");
  add_chapters(chapters, parts().courses, "", "Course");
  return chapters;
}

const Chapter& chapter_of(const std::vector<Chapter>& chapters, const std::string& key) {
  const Chapter* found = &chapters[0];
  for (const Chapter& chapter : chapters)
    if (key.starts_with(chapter.prefix) && chapter.prefix.size() > found->prefix.size()) found = &chapter;
  return *found;
}

/// A scenario's keys, chapter by chapter: each as `chapter_text` of its keys.
template <typename ChapterText>
std::string by_chapter(const std::vector<Key>& keys, ChapterText&& chapter_text) {
  std::string text;
  const std::vector<Chapter> chapters = all_chapters();
  for (const Chapter& chapter : chapters) {
    std::vector<Key> own;
    for (const Key& key : keys)
      if (&chapter_of(chapters, key.name) == &chapter) own.push_back(key);
    text += chapter_text(chapter, own);
  }
  return text;
}

/// docs/keys.md.
std::string page_of(const std::vector<Key>& keys) {
  return fmt::format(
      "# Keys and columns\n\n"
      "Made by `understory keys --markdown`, a test checks that it is current. `understory keys SCENARIO` "
      "shows the values of one scenario; [scenarios.md](scenarios.md) says how a scenario is written. A "
      "value without a source was chosen or measured here.\n\n{}"
      "## Columns of flights.csv\n\n"
      "A row per flight of a campaign; the keys of each line of flights.jsonl, too.\n\n{}\n"
      "## Keys of result.json\n\n{}\n"
      "## Columns of trajectory.csv\n\n"
      "A row each 5 ms: time, the true pose of the centre of mass in the world (quaternion from body to "
      "world), velocity, angular rate about the body's axes; `est_`: the same as the aircraft estimates it; "
      "commands; what the actuators did of them; distance from the wing to the nearest obstacle.\n\n"
      "```\n{}```\n",
      by_chapter(keys,
                 [](const Chapter& chapter, const std::vector<Key>& own) {
                   return fmt::format("## {}\n\n{}\n\n{}\n", chapter.title, chapter.text,
                                      to_markdown(table_of(own, false)));
                 }),
      to_markdown(table_of(flight_row_columns(), true)), to_markdown(table_of(result_keys(), true)),
      trajectory_columns);
}

std::string json_of(const std::vector<Key>& keys, const std::vector<Key>& defaults) {
  Json json = Json::array();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Key& key = keys[i];
    const auto value_of = [](const std::string& text) {
      const Json value = Json::parse(text, nullptr, false);
      return value.is_discarded() ? Json(text) : value;
    };
    json.push_back({{"key", key.name},
                    {"value", value_of(key.value)},
                    {"default", value_of(defaults[i].value)},
                    {"unit", key.unit},
                    {"range", key.range},
                    {"meaning", key.meaning},
                    {"source", key.source}});
  }
  return json_text(json, 1) + "\n";
}

std::string lines_of(const std::vector<Key>& keys, const std::vector<Key>& defaults) {
  return by_chapter(keys, [&](const Chapter& chapter, const std::vector<Key>& own) {
    std::string text =
        fmt::format("{}# {}: {}\n", chapter.prefix.empty() ? "" : "\n", chapter.title, chapter.text);
    for (const Key& key : own) {
      const std::string& usual = std::ranges::find(defaults, key.name, &Key::name)->value;
      text += fmt::format("{}: {}{}{}  ({})  {}{}{}\n", key.name, key.value, key.unit.empty() ? "" : " ",
                          key.unit, key.range, key.meaning, key.source.empty() ? "" : " [" + key.source + "]",
                          key.value == usual ? "" : fmt::format("; default {}", usual));
    }
    return text;
  });
}

/// Every key in which two scenarios differ, with both values.
std::string differences_of(const std::string& one, const std::string& other) {
  const auto keys_in = [](const std::string& name) {
    return flat_keys(scenario_to_text(load_scenario(scenario_file(name))), name);
  };
  const FlatKeys first = keys_in(one), second = keys_in(other);
  Table table{{"key", one, other}};
  for (const auto& [key, value] : first)
    if (key != "name" && value_in(second, key) != value) table.add(key, value, value_in(second, key));
  for (const auto& [key, value] : second)
    if (key != "name" && value_in(first, key) == "-" && value != "-") table.add(key, std::string("-"), value);
  return table.rows.empty() ? fmt::format("{} and {} differ in their names alone\n", one, other)
                            : to_text(table);
}

int run_keys(const KeysArguments& arguments) {
  if (!arguments.against.empty()) {
    fmt::print("{}", differences_of(arguments.scenario, arguments.against));
    return exit_goal;
  }
  const std::vector<Key> defaults = keys_of(scenario_from_text("{}", "defaults"));
  const std::vector<Key> keys =
      arguments.scenario.empty() ? defaults : keys_of(load_scenario(scenario_file(arguments.scenario)));
  fmt::print("{}", arguments.json       ? json_of(keys, defaults)
                   : arguments.markdown ? page_of(keys)
                                        : lines_of(keys, defaults));
  return exit_goal;
}

}  // namespace

void add_keys_command(CommandLine& line) {
  const auto arguments = std::make_shared<KeysArguments>();
  Command& command = line.add({"keys", "print each key of a scenario: value, unit, range, meaning, source",
                               "understory keys dense --against forest"});
  const auto scenario = command.text("scenario", "SCENARIO", arguments->scenario,
                                     "scenario whose values are printed (without it: the default values)");
  command
      .text("--against", "SCENARIO", arguments->against,
            "print only the keys in which the two scenarios differ, with both values")
      .needs(scenario);
  const auto json = command.flag("--json", arguments->json, "print the keys as JSON");
  command
      .flag("--markdown", arguments->markdown,
            "print the keys and the columns of results as Markdown, in the form of docs/keys.md")
      .excludes(json);
  command.runs([arguments] { return run_keys(*arguments); });
}

}  // namespace understory
