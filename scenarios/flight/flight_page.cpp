#include "scenarios/flight/flight_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "perception/io/picture_codecs.hpp"
#include "perception/io/text_file.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/flight/flight_arrays.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/report/page.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t maximum_film_bytes = std::size_t{1} << 30;

/// That the detector looks at.
std::vector<double> depths_of(const Flight& flight) {
  const std::vector<double>& depths_m = flight.scenario().perception.pushbroom.depths_m;
  return depths_m.empty() ? std::vector{flight.rig().rig.detection_depth_m} : depths_m;
}

Json camera_of(const Flight& flight) {
  const StereoRig& rig = flight.rig().rig;
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
          {"depths_m", depths_of(flight)},
          {"baseline_m", rig.baseline_m}};
}

Json result_of(const FlightResult& result, const Flight& flight) {
  Json rows = Json::array();
  const auto add = [&](const char* name, const std::string& text) { rows.push_back({name, text}); };
  add("outcome", std::string(word_for(result.outcome)));
  add("flown", fmt::format("{:.1f} m in {:.2f} s, {:.1f} m/s on average", result.distance_m,
                           result.simulated_s, result.mean_speed_mps));
  add("minimum clearance", std::isfinite(result.minimum_clearance_m)
                               ? fmt::format("{:.2f} m", result.minimum_clearance_m)
                               : "no obstacles");
  add("estimate's error", fmt::format("{:.2f} m on average, {:.2f} m at most", result.position_error_mean_m,
                                      result.position_error_max_m));
  add("detections", fmt::format("{} in {} frames", result.detections, result.frames));
  add("points remembered", fmt::format("{}", result.remembered_points));
  const PlannerCounts& planner = result.planner;
  add("plans", fmt::format("{}: {} straight, {} solved, {} kept, {} fallback", planner.replans,
                           planner.straight, planner.solved, planner.kept, planner.fallback));
  add("detector",
      uses_images(flight.scenario().perception.detector)
          ? fmt::format("{}, looking {:.1f} m ahead", result.detector, fmt::join(depths_of(flight), " and "))
          : result.detector);
  add("state", result.state_source);
  add("renderer", result.renderer.empty() ? "none: no images" : result.renderer);
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

namespace {

/// What page and track share.
Json facts_of(const Flight& flight, const FlightResult& result, const FlightTrack& track,
              const FlightStory& story) {
  const Scenario& scenario = flight.scenario();
  Json facts{{"kind", "flight"},
             {"title", fmt::format("{}, seed {}", scenario.name, scenario.seed)},
             {"program", fmt::format("understory {} ({})", understory_version, understory_commit)},
             {"outcome", word_for(result.outcome)},
             {"sentence", story.outcome},
             {"story", story.before},
             {"digest", result.digest},
             {"t_end_s", flight.clock().t_s()},
             {"t_launch_s", track.launch_s}};
  facts["course"] = {{"goal_x_m", scenario.goal_x_m()},
                     {"half_width_m", scenario.forest.half_width_m},
                     {"minimum_altitude_m", scenario.band.minimum_altitude_m},
                     {"maximum_altitude_m", scenario.band.maximum_altitude_m},
                     {"cruise_altitude_m", scenario.band.cruise_altitude_m}};
  facts["impact"] = Json();
  if (story.impact_world) {
    const Eigen::Vector3d& place = *story.impact_world;
    facts["impact"] = {{"position", {place.x(), place.y(), place.z()}}, {"part", story.part}};
  }
  facts["camera"] = uses_images(scenario.perception.detector) ? camera_of(flight) : Json();
  facts["events"] = Json::array();
  for (const FlightEvent& event : story.events)
    facts["events"].push_back({{"t_s", event.t_s}, {"kind", event.kind}, {"text", event.text}});
  facts["film"] = Json();
  return facts;
}

}  // namespace

std::string flight_page(const Flight& flight, const FlightResult& result, const FlightTrack& track,
                        const FlightStory& story, const FlightPageExtras& extras) {
  const Scenario& scenario = flight.scenario();
  PageContent page;
  page.title = fmt::format("{}, seed {}: {}", scenario.name, scenario.seed, word_for(result.outcome));
  Json facts = facts_of(flight, result, track, story);
  facts["command"] = "understory fly " + arguments_that_fly(scenario, extras.data_root);
  facts["warning"] = extras.warning;
  facts["scenario"] = scenario_to_text(scenario);
  facts["result"] = result_of(result, flight);
  facts["keys"] = changed_keys(scenario);
  if (!extras.film.empty()) {
    facts["film"] = {{"times", "film_t"}};
    page.arrays.add("film_t", 1, extras.film_times_s);
    page.film = read_file(extras.film, maximum_film_bytes);
    if (!extras.last_picture.empty()) {
      const auto still = picture_codecs().encode(".jpg", extras.last_picture);
      page.still.assign(still.begin(), still.end());
    }
  }
  add_track(flight, track, story, PageDetail::everything, page.arrays, facts);
  page.facts = json_text(facts);
  return page_html(extras.data_root, page);
}

std::string compact_flight(const Flight& flight, const FlightResult& result, const FlightTrack& track,
                           const FlightStory& story) {
  Json facts = facts_of(flight, result, track, story);
  PageArrays arrays(true);
  add_track(flight, track, story, PageDetail::compact, arrays, facts);
  return packed_part(json_text(facts), arrays);
}

}  // namespace understory
