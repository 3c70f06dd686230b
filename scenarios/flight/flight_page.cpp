#include "scenarios/flight/flight_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "perception/io/picture_codecs.hpp"
#include "perception/io/text_file.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/flight/flight_arrays.hpp"
#include "scenarios/flight/flight_story.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/report/page.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t maximum_film_bytes = std::size_t{1} << 30;

/// "pushbroom at 10.1 m", "pushbroom at 9.1, 4.8 m", "stereo_bm from 1.5 to 15 m".
std::string words_of_detector(const FlightLog& log) {
  const PerceptionSection& perception = log.scenario.perception;
  const std::string& name = log.result.detector;
  if (const std::vector<double> depths_m = compared_depths_m(log); !depths_m.empty())
    return fmt::format("{} at {:.1f} m", name, fmt::join(depths_m, ", "));
  if (!name.starts_with("stereo_")) return name;
  return fmt::format("{} from {:.1f} to {:.1f} m", name, perception.full_stereo.minimum_depth_m,
                     perception.full_stereo.maximum_depth_m);
}

Json camera_of(const FlightLog& log) {
  const StereoRig& rig = log.rig.rig;
  Json T_body_camera = Json::array();
  const Eigen::Matrix4d matrix = rig.T_body_camera.matrix();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) T_body_camera.push_back(matrix(row, column));
  return {{"width_px", rig.width_px},
          {"height_px", rig.height_px},
          {"fx", rig.focal_px},
          {"fy", rig.focal_px},
          {"cx", rig.center_left_x_px},
          {"cy", rig.center_y_px},
          {"T_body_camera", T_body_camera},
          {"depths_m", compared_depths_m(log)},
          {"baseline_m", rig.baseline_m}};
}

Json result_of(const FlightLog& log) {
  Json rows = Json::array();
  for (const auto& [name, text] : result_lines(log.result)) rows.push_back({name, text});
  rows.push_back({"detector", words_of_detector(log)});
  rows.push_back({"state", log.result.state_source});
  return rows;
}

/// Keys that say which numbers others start from.
const std::vector<std::string> preset_keys{
    "name",    "rig",      "sensors.grade", "perception.preset", "estimation.preset", "autopilot.preset",
    "launch.", "airframe."};

bool is_preset(const std::string& key) {
  return std::ranges::any_of(preset_keys, [&](const std::string& preset) {
    return preset.back() == '.' ? key.starts_with(preset) : key == preset;
  });
}

FlatKeys keys_in(const Scenario& scenario) { return flat_keys(scenario_to_text(scenario), scenario.name); }

/// [key, default, value] where the scenario has another value than its presets and defaults give.
Json changed_keys(const Scenario& scenario) {
  const FlatKeys given = keys_in(scenario);
  std::vector<std::string> presets;
  for (const auto& [key, value] : given)
    if (is_preset(key)) presets.push_back(key + "=" + value);
  const FlatKeys plain = keys_in(scenario_from_text("{}", "defaults")),
                 preset = keys_in(scenario_from_text("{}", "presets", presets));
  Json rows = Json::array();
  for (const auto& [key, value] : given) {
    const std::string standard = value_in(is_preset(key) ? plain : preset, key);
    if (value != standard && key != "name") rows.push_back({key, standard, value});
  }
  return rows;
}

/// What page and track share.
Json facts_of(const FlightLog& log, const FlightStory& story) {
  const Scenario& scenario = log.scenario;
  Json facts{{"kind", "flight"},
             {"title", fmt::format("{}, seed {}", scenario.name, scenario.seed)},
             {"program", fmt::format("understory {} ({})", understory_version, understory_commit)},
             {"outcome", word_for(log.result.outcome)},
             {"sentence", story.outcome},
             {"story", story.before},
             {"digest", log.result.digest},
             {"t_end_s", seconds(log.moments.back().t_ns)},
             {"t_launch_s", log.launch_ns ? seconds(*log.launch_ns) : 0.0}};
  facts["course"] = {{"goal_x_m", scenario.goal_x_m()},
                     {"half_width_m", scenario.forest.half_width_m},
                     {"minimum_altitude_m", scenario.band.minimum_altitude_m},
                     {"maximum_altitude_m", scenario.band.maximum_altitude_m},
                     {"cruise_altitude_m", scenario.band.cruise_altitude_m}};
  facts["impact"] = Json();
  if (log.touch.with != Contact::none) {
    const Eigen::Vector3d& place = log.touch.position_world;
    facts["impact"] = {{"position", {place.x(), place.y(), place.z()}}, {"part", log.touch.part}};
  }
  facts["camera"] = scenario.perception.part().needs_images ? camera_of(log) : Json();
  facts["events"] = Json::array();
  for (const FlightEvent& event : story.events)
    facts["events"].push_back({{"t_s", event.t_s}, {"kind", event.kind}, {"text", event.text}});
  facts["film"] = Json();
  return facts;
}

}  // namespace

std::string arguments_that_fly(const Scenario& scenario, const fs::path& data_root) {
  constexpr std::size_t maximum_settings = 12;  // more than a person would paste
  const fs::path library = data_root / "scenarios" / "library" / (scenario.name + ".yaml");
  std::error_code ignored;
  if (!fs::exists(library, ignored)) return "scenario.yaml";
  const FlatKeys wanted = keys_in(scenario);
  std::vector<std::string> settings{fmt::format("seed={}", scenario.seed)};
  for (const bool presets : {true, false}) {
    const FlatKeys now = keys_in(load_scenario(library, settings));
    for (const auto& [key, value] : wanted)
      if (is_preset(key) == presets && value_in(now, key) != value) settings.push_back(key + "=" + value);
    if (settings.size() > maximum_settings) return "scenario.yaml";
  }
  try {
    if (scenario_to_text(load_scenario(library, settings)) != scenario_to_text(scenario))
      return "scenario.yaml";
  } catch (const ScenarioError&) {  // a list's entry cannot be set by itself
    return "scenario.yaml";
  }
  std::string arguments = fmt::format("{} --seed {}", scenario.name, scenario.seed);
  for (std::size_t i = 1; i < settings.size(); ++i)
    arguments += settings[i].find_first_of(" [\"") == std::string::npos
                     ? fmt::format(" --set {}", settings[i])
                     : fmt::format(" --set '{}'", settings[i]);
  return arguments;
}

std::string flight_page(const FlightLog& log, const FlightPageExtras& extras) {
  const Scenario& scenario = log.scenario;
  const FlightStory story = story_of(log);
  PageContent page;
  page.title = fmt::format("{}, seed {}: {}", scenario.name, scenario.seed, word_for(log.result.outcome));
  Json facts = facts_of(log, story);
  facts["command"] = "understory fly " + arguments_that_fly(scenario, extras.data_root);
  facts["warning"] = extras.warning;
  facts["scenario"] = scenario_to_text(scenario);
  facts["result"] = result_of(log);
  facts["keys"] = changed_keys(scenario);
  if (!extras.film.empty()) {
    facts["film"] = {{"times", "film_t"}};
    page.arrays.add("film_t", 1, extras.film_times_s);
    page.film = read_file(extras.film, maximum_film_bytes);
    if (!extras.last_picture.empty()) {
      const auto still = picture_codecs().encode_jpeg(extras.last_picture, 85);
      page.still.assign(still.begin(), still.end());
    }
  }
  add_flight(log, story, PageDetail::everything, page.arrays, facts);
  facts["sections"] = facts_of(extras.chapter, page);
  if (!extras.chapter.empty()) facts["story"].insert(facts["story"].begin(), extras.chapter.front().text);
  page.facts = json_text(facts);
  return page_html(extras.data_root, page);
}

std::string compact_flight(const FlightLog& log) {
  const FlightStory story = story_of(log);
  Json facts = facts_of(log, story);
  PageArrays arrays(true);
  add_flight(log, story, PageDetail::compact, arrays, facts);
  return packed_part(json_text(facts), arrays);
}

}  // namespace understory
