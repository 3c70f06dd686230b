#include "scenarios/scenario/scenario_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "scenarios/config/field_writer.hpp"
#include "scenarios/config/keys.hpp"
#include "scenarios/config/named_seed.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/parts/checked_parts.hpp"
#include "scenarios/scenario/filter_for_sensors.hpp"
#include "scenarios/scenario/plugin.hpp"
#include "scenarios/scenario/scenario_rig.hpp"
#include "sim/aircraft/aerodynamics.hpp"
#include "sim/scene/world_config.hpp"

namespace understory {
namespace {

using Sources = std::vector<ConfigNode>;  ///< the file, then every --with, then every --set

/// It names the run folder, so it must be a plain word.
bool is_plain_word(const std::string& name) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
  };
  return !name.empty() && name.size() <= 100 && name.front() != '.' && std::ranges::all_of(name, is_plain);
}

/// Conditions on a scenario's own list of obstacles.
template <typename Expect>
void check_obstacles(const std::vector<ListedObstacle>& obstacles, Expect&& expect) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const ListedObstacle& listed = obstacles[i];
    const Eigen::Vector3d& size = listed.size_m;
    const std::string key = fmt::format("obstacles[{}].", i);
    expect(is_plain_word(listed.name),
           key + "name: must be letters, digits, '-', '_' and '.', at most 100, no '.' first");
    expect(std::ranges::none_of(obstacles.begin(), obstacles.begin() + i,
                                [&](const ListedObstacle& other) { return other.name == listed.name; }),
           key + "name: must differ from the names of the other obstacles");
    expect(listed.shape != ListedShape::sphere || (size.x() == size.y() && size.y() == size.z()),
           key + "size_m: a sphere requires three equal numbers");
    expect(listed.shape != ListedShape::capsule || (size.x() == size.y() && size.z() > size.x()),
           key +
               "size_m: a capsule requires x and y to be equal and z to be larger; with three equal "
               "numbers it is a sphere");
  }
  expect(obstacles.size() <= 1000, "obstacles: must have at most 1000 entries");
}

/// A course may have so many obstacles.
template <typename Expect>
void check_counts(const Scenario& scenario, Expect&& expect) {
  const double trees =
      scenario.forest.length_m * 2 * scenario.forest.half_width_m / scenario.forest.square_metres_per_tree;
  expect(scenario.course != "forest" || trees <= maximum_obstacles,
         fmt::format("forest.square_metres_per_tree: a forest may have at most {} trees, this one would have "
                     "about {:.0f} (length_m, half_width_m)",
                     maximum_obstacles, trees));
}

/// Conditions between keys of a part, which are at `place`.
template <typename List, typename Expect>
void check_parts(const List& list, const PartConfigs& configs, const std::string& place,
                 const Scenario& scenario, Expect&& expect) {
  for (const auto& part : list.all()) {
    const std::string fault = part.fault ? part.fault(*configs.find(part.name), scenario) : "";
    expect(fault.empty(), place + part.name + "." + fault);
  }
}

/// Throws what does not hold, "key: must ...", with the place where the key is given, else `name`.
auto expecting(const Sources& sources, const std::string& name) {
  return [&sources, name](bool holds, const std::string& what) {
    if (holds) return;
    const std::string origin = origin_of(sources, what.substr(0, what.find(':')));
    throw ScenarioError(fmt::format("{}: {}", origin.empty() ? name : origin, what));
  };
}

template <typename Expect>
void check_detectors(const Scenario& scenario, Expect&& expect) {
  check_parts(parts().detectors, scenario.perception.detectors, "perception.", scenario, expect);
  const FullStereoCrop& crop = scenario.perception.full_stereo;
  expect(crop.minimum_depth_m < crop.maximum_depth_m,
         fmt::format("perception.full_stereo.minimum_depth_m: {} must be less than maximum_depth_m, {}",
                     crop.minimum_depth_m, crop.maximum_depth_m));
}

template <typename Expect>
void check_ideal(const IdealConfig& ideal, Expect&& expect) {
  for (const std::string& part : ideal.parts) {
    expect(std::ranges::find(ideal_part_names, part) != ideal_part_names.end(),
           fmt::format("ideal.parts: expected some of {}, got {}", fmt::join(ideal_part_names, ", "), part));
    expect(std::ranges::count(ideal.parts, part) == 1, fmt::format("ideal.parts: {} is named twice", part));
  }
  expect(ideal.hits.empty() || ideal.redraw != 0, "ideal.hits: requires ideal.redraw to be at least 1");
}

/// Conditions between several keys.
void check(const Scenario& scenario, const Sources& sources, const std::string& name) {
  const auto expect = expecting(sources, name);
  expect(is_plain_word(scenario.name),
         "name: must be letters, digits, '-', '_' and '.', at most 100, no '.' first");
  expect(scenario.forest.radius_min_m <= scenario.forest.radius_max_m,
         "forest.radius_min_m: must be at most forest.radius_max_m");
  expect(scenario.band.minimum_altitude_m < scenario.band.maximum_altitude_m,
         "band.minimum_altitude_m: must be below band.maximum_altitude_m");
  expect(scenario.band.cruise_altitude_m > scenario.band.minimum_altitude_m &&
             scenario.band.cruise_altitude_m < scenario.band.maximum_altitude_m,
         "band.cruise_altitude_m: must be between band.minimum_altitude_m and band.maximum_altitude_m");
  expect(scenario.airframe.span_m == Airframe().span_m,
         fmt::format("airframe.span_m: must be {}: the body that collides has this span "
                     "(models/airframe/delta_wing.xml)",
                     Airframe().span_m));
  check_counts(scenario, expect);
  expect(
      scenario.world.scenery == Scenery::plain || scenario.course == "forest" || scenario.course == "clear",
      "world.scenery: woods requires the course forest or clear");
  check_obstacles(scenario.obstacles, expect);
  expect(scenario.actuators.pitch_speed_mps == 0 ||
             scenario.actuators.pitch_speed_mps > scenario.actuators.thrust_speed_mps,
         "actuators.pitch_speed_mps: must be 0 or more than actuators.thrust_speed_mps");
  const SensorsConfig& sensors = scenario.sensors;
  const std::pair<const char*, int> rates_hz[] = {{"autopilot.replan_", scenario.autopilot.replan_rate_hz},
                                                  {"cameras.", scenario.cameras.rate_hz},
                                                  {"sensors.imu_", sensors.imu_rate_hz},
                                                  {"sensors.pitot_", sensors.pitot_rate_hz},
                                                  {"sensors.barometer_", sensors.barometer_rate_hz},
                                                  {"sensors.magnetometer_", sensors.magnetometer_rate_hz},
                                                  {"sensors.gps_", sensors.gps_rate_hz}};
  for (const auto& [key, rate_hz] : rates_hz)
    expect(physics_rate_hz % rate_hz == 0, fmt::format("{}rate_hz: must divide 1200, as 12 and 15 do", key));
  const PerceptionSection& perception = scenario.perception;
  check_detectors(scenario, expect);
  check_parts(parts().state_sources, scenario.estimation.sources, "estimation.", scenario, expect);
  check_parts(parts().planners, scenario.autopilot.planners, "autopilot.", scenario, expect);
  check_parts(parts().courses, scenario.courses, "", scenario, expect);
  // The estimator remembers its state for a second and accepts frames up to half a second old.
  const double cost_s = perception.cost_s(), period_s = 1.0 / scenario.cameras.rate_hz;
  expect(scenario.cameras.latency_s + cost_s + std::min(cost_s, period_s) <= 0.5,
         "perception.compute.factor: a frame must be processed within 0.5 s of its exposure");
  expect(std::max(scenario.cameras.exposure_s, scenario.cameras.rolling_shutter_s) <= period_s,
         "cameras.rolling_shutter_s: it and exposure_s must each be at most 1 / rate_hz");
  check_ideal(scenario.ideal, expect);
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
    const FaultConfig& fault = scenario.faults[i];
    expect(can_have(fault.sensor, fault.kind),
           fmt::format("faults[{}].kind: must be, for this sensor, {}", i, fault_kinds_of(fault.sensor)));
    const auto must_be = [&](FaultKind kind, double minimum, double maximum) {
      expect(fault.kind != kind || (fault.value >= minimum && fault.value <= maximum),
             fmt::format("faults[{}].value: must be, for this kind, from {} to {}", i, minimum, maximum));
    };
    must_be(FaultKind::cover, -1, 1);
    must_be(FaultKind::delay, 0, 0.3);
    must_be(FaultKind::weaken, 0, 1);
  }
}

/// The stack believes in one airframe: what the filter and the planner need of it they take from there.
void take_airframe(const Airframe& airframe, Scenario& scenario) {
  FilterConfig& filter = scenario.estimation.filter();
  filter.gravity_mps2 = airframe.gravity_mps2;
  filter.angle_of_attack.mass_kg = filter.sideslip.mass_kg = airframe.mass_kg;
  filter.angle_of_attack.air_density_kgpm3 = filter.sideslip.air_density_kgpm3 = airframe.air_density_kgpm3;
  filter.angle_of_attack.wing_area_m2 = airframe.wing_area_m2;
  filter.angle_of_attack.pitch_damping_nmspr = airframe.rate_damping_nmspr.y();
  filter.sideslip.winglets_area_m2 = 2 * airframe.winglet_area_m2;
  filter.sideslip.winglets_body_m = {airframe.winglet_x_m, 0, airframe.winglet_z_m};
}

using Files = std::vector<FileConfig>;

/// Adds what a flight is going to read.
void add_file(const std::filesystem::path& file, const std::string& origin, Files& files) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return;  // whoever reads it says so
  if (!std::filesystem::is_regular_file(file, ignored))
    throw ScenarioError(fmt::format("{}{}{}: must be a regular file, which can be read again", origin,
                                    origin.empty() ? "" : ": ", file.string()));
  if (std::ranges::find(files, file.string(), &FileConfig::file) == files.end())
    files.push_back({file.string(), digest_of_file(file)});
}

/// Where a key's file is: beside the file that gives it, from the working directory, or in a further folder.
/// What is found is absolute, so that a run's scenario flies again from anywhere; else the name as it is.
std::string found_file(const std::string& name, const std::string& origin,
                       const std::filesystem::path& further = {}) {
  const std::filesystem::path path(name);
  if (name.empty() || path.is_absolute()) return name;
  const std::filesystem::path giver = origin.starts_with("--") ? "" : origin.substr(0, origin.rfind(':'));
  std::error_code ignored;
  for (const std::filesystem::path& candidate : {giver.parent_path() / path, path, further / path})
    if (std::filesystem::exists(candidate, ignored))
      return std::filesystem::absolute(candidate).lexically_normal().string();
  return name;
}

/// A plain word is a name in models/rigs.
bool is_rig_file(const std::filesystem::path& rig) { return rig.has_extension() || rig.has_parent_path(); }

/// Each with its hash, by the one list of all that names files: scenario, campaign, tuning and recording are
/// the same only where these are.
Files files_of(const Scenario& scenario, const Sources& sources) {
  Files files;
  const auto add = [&](const std::string& file, const char* key) {
    if (!file.empty()) add_file(file, origin_of(sources, key), files);
  };
  if (is_rig_file(scenario.rig))
    for (const std::filesystem::path& file : files_of_rig(scenario.rig, scenario.cameras.raw))
      add(file.string(), "rig");
  add(scenario.forest.trees_file, "forest.trees_file");
  add(scenario.autopilot.actions, "autopilot.actions");
  add(scenario.ideal.hits, "ideal.hits");
  for (const FileConfig& plugin : scenario.plugins)
    for (const FileConfig& imported : load_plugin(plugin.file, "plugins").imported) files.push_back(imported);
  return files;
}

/// A run's scenario flies again only with the files that it flew with.
void require_hashes(const char* list, const Files& asked, const Files& there, const Sources& sources) {
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const std::string key = fmt::format("{}[{}].", list, i),
                      file = found_file(asked[i].file, origin_of(sources, key + "file"));
    const auto is = std::ranges::find(there, file, &FileConfig::file);
    if (is != there.end() && !asked[i].hash.empty() && asked[i].hash != is->hash)
      throw ScenarioError(fmt::format("{}: {}hash: must be {}, the hash of {}, got {}",
                                      origin_of(sources, key + "hash"), key, is->hash, file, asked[i].hash));
  }
}

/// The aircraft's place on the catapult. It is known before the flight, so the filter may start from it.
Eigen::Vector3d rail_start_world(const LaunchConfig& launch) {
  return {-launch.rail_length_m * std::cos(launch.climb_angle_rad), 0,
          launch.altitude_m - launch.rail_length_m * std::sin(launch.climb_angle_rad)};
}

Sources sources_of(ConfigNode file, const std::vector<std::string>& settings,
                   const std::vector<std::filesystem::path>& with = {}) {
  Sources sources{std::move(file)};
  for (const std::filesystem::path& more : with) sources.push_back(parse_config_file(more));
  for (const std::string& setting : settings) sources.push_back(parse_assignment(setting));
  return sources;
}

/// Loads the plug-ins that the sources name, whose parts and keys the sources may name, too, and those of
/// --plugin. Gives all of them, with absolute paths and hashes.
std::vector<FileConfig> load_plugins(const Sources& sources) {
  std::vector<FileConfig> loaded;
  const auto load = [&](const std::string& file, const std::string& origin) {
    const Plugin& plugin = load_plugin(file, origin);
    if (std::ranges::find(loaded, plugin.file, &FileConfig::file) == loaded.end())
      loaded.push_back({plugin.file, plugin.hash});
  };
  for (const ConfigNode& source : sources)
    if (const ConfigNode* list = find_child(source, "plugins"))
      for (const ConfigNode& entry : list->children)
        if (const ConfigNode* file = find_child(entry, "file"))
          load(found_file(file->text, file->origin), file->origin + ": plugins");
  for (const std::string& file : given_plugins()) load(found_file(file, ""), "--plugin");
  return loaded;
}

/// Twice: the first reading learns the presets and the launch, the second puts the written keys over them.
Scenario compose(const Sources& sources, const std::string& name) {
  const std::vector<FileConfig> plugins = load_plugins(sources);
  Scenario first;
  for (const ConfigNode& source : sources) read_config(source, first);
  Scenario scenario;
  static_cast<SensorsConfig&>(scenario.sensors) = sensors_of_grade(first.sensors.grade);
  scenario.perception.pushbroom() = pushbroom_of(first.perception.preset, first.rig);
  FilterConfig& filter = scenario.estimation.filter();
  if (first.estimation.preset == FilterPreset::original) filter = original_filter();
  if (first.estimation.preset == FilterPreset::windy) filter = windy_filter();
  // The original's filter knew nothing of its sensors; ideal sensors leave the nominal ones' margins.
  if (first.estimation.preset != FilterPreset::original && first.sensors.grade != SensorGrade::ideal)
    filter = filter_for_sensors(filter, sensors_of_grade(first.sensors.grade));
  scenario.autopilot = planning_of(first.autopilot.preset);
  // Woods are seen through a lens: without one their edges are sharper than a camera's can be.
  if (first.world.scenery == Scenery::woods) {
    scenario.cameras.psf_px = 0.6;
    scenario.cameras.vignetting_power = 4;
  }
  if (first.is_long()) {
    scenario.time_limit_s =
        std::min(600.0, std::ceil(2 * first.goal_x_m() / first.autopilot.flight_model.cruise_speed_mps));
    scenario.forest.half_width_m = 36;
    scenario.band.cruise_altitude_m = 4;  // a barometer that drifts for longer needs more room above
    scenario.sensors.gps.enabled = true;
    filter.gps.enabled = false;  // the estimate stays that of a short course: GPS only says where the way is
  }
  filter.distrust.imu_gap_s = 1.5 / first.sensors.imu_rate_hz;
  filter.start.position_world_m = rail_start_world(first.launch);
  filter.start.pitch_rad =
      first.launch.climb_angle_rad + release_angle_of_attack_rad(first.airframe, first.launch.speed_mps);
  take_airframe(first.airframe, scenario);
  for (const ConfigNode& source : sources) read_config(source, scenario);
  require_hashes("plugins", scenario.plugins, plugins, sources);
  scenario.plugins = plugins;
  if (is_rig_file(scenario.rig)) scenario.rig = found_file(scenario.rig, origin_of(sources, "rig"));
  scenario.forest.trees_file =
      found_trees_file(scenario.forest.trees_file, origin_of(sources, "forest.trees_file"));
  scenario.autopilot.actions =
      found_file(scenario.autopilot.actions, origin_of(sources, "autopilot.actions"));
  scenario.ideal.hits = found_file(scenario.ideal.hits, origin_of(sources, "ideal.hits"));
  const Files files = files_of(scenario, sources);
  require_hashes("files", scenario.files, files, sources);
  scenario.files = files;
  check(scenario, sources, name);
  return scenario;
}

}  // namespace

AutopilotSection planning_of(PlanningPreset preset) {
  AutopilotSection section;
  section.preset = preset;
  if (preset == PlanningPreset::thorough) return section;
  // At once for what is new near the way, seldom otherwise, with smaller searches.
  section.replan_rate_hz = 600;  // the moments at which it may plan
  section.straight_period_s = 0.1;
  section.avoiding_period_s = 0.025;
  section.planner.refresh_s = 0.105;
  section.planner.search.iterations = 80;
  section.planner.improvement.iterations = 16;
  return section;
}

Scenario load_scenario(const std::filesystem::path& file, const std::vector<std::string>& settings,
                       const std::vector<std::filesystem::path>& with) {
  return compose(sources_of(parse_config_file(file), settings, with), file.string());
}

Scenario load_changed_scenario(const std::filesystem::path& file, const std::vector<ConfigNode>& changes) {
  Sources sources{parse_config_file(file)};
  sources.insert(sources.end(), changes.begin(), changes.end());
  return compose(sources, file.string());
}

Scenario scenario_from_text(const std::string& text, const std::string& name,
                            const std::vector<std::string>& settings) {
  return compose(sources_of(parse_yaml(text, name), settings), name);
}

std::string where_given(const std::filesystem::path& file, const std::vector<std::string>& settings,
                        std::string_view key, const std::vector<std::filesystem::path>& with) {
  const std::string origin = origin_of(sources_of(parse_config_file(file), settings, with), key);
  return origin.empty() ? file.string() : origin;
}

std::string found_trees_file(const std::string& trees_file, const std::string& origin) {
  const char* data = std::getenv("UNDERSTORY_DATA");
  return found_file(trees_file, origin, data != nullptr ? data : "");
}

std::vector<Key> keys_of(Scenario scenario) { return list_keys(fields_of(scenario)); }

std::string scenario_to_text(const Scenario& scenario) { return write_config(scenario); }

Wood course_wood(const Scenario& scenario) {
  const CoursePart& course = *parts().courses.find(scenario.course);
  Planted trunks = checked(course, {scenario, scenario.seed});
  Wood wood;
  if (scenario.world.scenery == Scenery::woods)
    wood = grow(trunks.obstacles, woods_of(scenario), seed_for(scenario.seed, "trees"), trunks.known);
  else
    wood.obstacles = std::move(trunks.obstacles);
  for (const ListedObstacle& listed : scenario.obstacles) wood.obstacles.push_back(placed(listed));
  return wood;
}

WoodsConfig woods_of(const Scenario& scenario) {
  return drawn(scenario.world.woods, seed_for(scenario.seed, "woods"));
}

std::vector<Obstacle> course_obstacles(const Scenario& scenario) { return course_wood(scenario).obstacles; }

std::vector<Obstacle> course_crowns(const Scenario& scenario) {
  std::vector<Obstacle> crowns;
  if (scenario.world.scenery == Scenery::plain) return crowns;
  try {
    const Wood wood = course_wood(scenario);
    for (const Tree& tree : wood.trees) {
      Obstacle crown;
      crown.from_world = crown.to_world = wood.obstacles[tree.first].from_world;
      crown.from_world.z() += tree.crown_base_m;
      crown.to_world.z() += tree.height_m;
      crown.radius_m = tree.crown_radius_m;
      crowns.push_back(crown);
    }
  } catch (const InputError&) {
  }
  return crowns;
}

void visit_fields(FieldVisitor& visit, VisionConfig& config) {
  visit("perception", static_cast<PerceptionSection&>(config));
  visit.group("autopilot", [&](FieldVisitor& within) { within("map", config.map); });
}

VisionConfig read_vision_config(const VisionConfigSources& sources, std::string_view rig) {
  for (const std::string& file : given_plugins()) load_plugin(found_file(file, ""), "--plugin");
  std::vector<ConfigNode> trees;
  for (const std::string& file : sources.with) trees.push_back(parse_config_file(file));
  for (const std::string& setting : sources.settings) trees.push_back(parse_assignment(setting));
  VisionConfig first;  // says which rule the others go over
  first.preset = sources.preset;
  for (const ConfigNode& tree : trees) read_config(tree, first);
  VisionConfig config;
  config.pushbroom() = pushbroom_of(first.preset, rig);
  if (sources.one_depth) config.pushbroom().depths_m.clear();
  for (const ConfigNode& tree : trees) read_config(tree, config);
  config.preset = first.preset;
  Scenario around;
  around.perception = config;
  check_detectors(around, expecting(trees, "--with"));
  return config;
}

std::string rig_named_in(const std::filesystem::path& recording) {
  const std::filesystem::path file = recording / "scenario.yaml";
  if (!std::filesystem::exists(file)) return "";
  const ConfigNode scenario = parse_config_file(file);
  const auto rig = std::ranges::find(scenario.children, "rig", &ConfigNode::key);
  return rig == scenario.children.end() ? "" : rig->text;
}

}  // namespace understory
