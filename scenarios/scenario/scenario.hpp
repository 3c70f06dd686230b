#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "estimation/dead_reckoning.hpp"
#include "estimation/filter_config.hpp"
#include "perception/perception_config.hpp"
#include "planning/airframe.hpp"
#include "planning/autopilot_config.hpp"
#include "planning/plan.hpp"
#include "scenarios/course/courses.hpp"
#include "scenarios/parts/parts.hpp"
#include "sim/aircraft/aircraft_config.hpp"
#include "sim/cameras/camera_config.hpp"
#include "sim/scene/world_config.hpp"
#include "sim/sensors/sensors_config.hpp"

/// Everything on which a flight depends. Each part is its module's own config struct, so that a field is
/// named, bounded and explained in one place. The sections here add what belongs to the composition.
namespace understory {

enum class FilterPreset { tuned, original, windy };  ///< which numbers estimation.filter starts from
enum class PlanningPreset { thorough, economical };  ///< how often, and with how much search, plans are made

inline constexpr std::array<std::pair<std::string_view, FilterPreset>, 3> filter_preset_names{
    {{"tuned", FilterPreset::tuned}, {"original", FilterPreset::original}, {"windy", FilterPreset::windy}}};
inline constexpr std::array<std::pair<std::string_view, PlanningPreset>, 2> planning_preset_names{
    {{"thorough", PlanningPreset::thorough}, {"economical", PlanningPreset::economical}}};
inline constexpr std::array<std::pair<std::string_view, SensorGrade>, 4> sensor_grade_names{
    {{"ideal", SensorGrade::ideal},
     {"nominal", SensorGrade::nominal},
     {"consumer", SensorGrade::consumer},
     {"rough", SensorGrade::rough}}};

/// Forwards a visitor past names that another key of the scenario stands for.
template <typename Visitor, std::size_t N>
struct VisitorWithout {
  Visitor& visit;
  std::array<std::string_view, N> left_out;

  template <typename... Arguments>
  void operator()(std::string_view name, Arguments&&... arguments) {
    for (const std::string_view other : left_out) {
      if (name == other) return;
    }
    visit(name, std::forward<Arguments>(arguments)...);
  }
};

/// Altitudes within which the flight must stay after it has climbed into them; leaving them ends it. A flight
/// over the trees or along the ground would prove nothing.
struct BandConfig {
  double minimum_altitude_m = 1;
  double maximum_altitude_m = 6;
  double cruise_altitude_m = 4.5;
};

/// How the scene looks. Whether obstacles are seen or felt is the course's business: forest.invisible,
/// .intangible.
struct WorldSection {
  WorldConfig world;
};

struct CameraSection {
  CameraConfig cameras;
  int rate_hz = 120;
  double latency_s = 0.008;
  double drop_probability = 0;
  bool raw = false;
  double raw_unit_m = 1;
};

struct SensorSection {
  std::uint64_t seed = 0;
  SensorGrade grade = SensorGrade::nominal;
  SensorsConfig sensors;
};

/// What a pair costs the aircraft's computer, in simulated time, never measured during a flight. Off: every
/// frame is looked at without delay. docs/thesis.md has the source of the numbers.
struct ComputeConfig {
  bool enabled = false;
  double factor = 8.3;
  double pushbroom_s = 0.0010;
  double more_depths = 0.4;
  double stereo_bm_s = 0.0090;
  double stereo_sgbm_s = 0.0127;
};

template <typename Visitor>
void visit_fields(Visitor& visit, ComputeConfig& config) {
  visit("enabled", config.enabled,
        "simulates the time that the aircraft's computer needs for each stereo pair; false: detection takes "
        "no time");
  visit("factor", config.factor, 0.001, 1000.0,
        "Ratio of the time on the aircraft's computer to the time on one thread of the machine that measured "
        "the other perception.compute keys. 8.3: the original detector takes 1.0 ms on that machine, and on "
        "a 1.7 GHz quad ARM Cortex-A9 it filled the 8.3 ms of a frame at 120 Hz. A larger factor is a slower "
        "computer. | Barry & Tedrake 2015");
  visit("pushbroom_s", config.pushbroom_s, 0.0, 1.0,
        "pushbroom detector's time per pair at one depth, rectification included, before compute.factor | "
        "docs/sources.md [17]");
  visit("more_depths", config.more_depths, 0.0, 1.0,
        "pushbroom detector's time for each further depth, as a share of compute.pushbroom_s | "
        "docs/benchmarks.md");
  visit("stereo_bm_s", config.stereo_bm_s, 0.0, 1.0,
        "StereoBM's time per pair with 112 disparities on the paper's rig, before compute.factor | "
        "docs/thesis.md");
  visit("stereo_sgbm_s", config.stereo_sgbm_s, 0.0, 1.0,
        "StereoSGBM's time per pair with 112 disparities and five paths, before compute.factor | "
        "docs/thesis.md");
}

struct PerceptionSection {
  std::string detector = "pushbroom";
  PushbroomPreset preset = PushbroomPreset::tuned;
  PushbroomConfig pushbroom = tuned_pushbroom("long");
  StereoBmConfig stereo_bm;
  StereoSgbmConfig stereo_sgbm;
  FullStereoCrop full_stereo;
  ComputeConfig compute;

  PartConfigs plugged = parts().detectors.configs();  ///< keys of the detectors of plug-ins

  const DetectorPart& part() const { return *parts().detectors.find(detector); }
  /// What one pair costs the aircraft's computer, simulated seconds; 0 for a detector that is not computed
  /// there.
  double cost_s() const {
    return compute.enabled && part().cost_s ? compute.factor * part().cost_s(*this) : 0;
  }
};

struct EstimationSection {
  std::string source = "filter";
  FilterPreset preset = FilterPreset::tuned;
  FilterConfig filter;
  DeadReckoningConfig dead_reckoning;
  PartConfigs plugged = parts().state_sources.configs();  ///< keys of the state sources of plug-ins
};

struct AutopilotSection {
  PlanningPreset preset = PlanningPreset::economical;
  std::string method = "sst";
  std::string actions;
  int replan_rate_hz = 120;
  AutopilotConfig autopilot;
  ManoeuvreLibraryConfig library;
  PartConfigs plugged = parts().planners.configs();  ///< keys of the planners of plug-ins
};

/// The numbers that a preset stands for (docs/decisions/015, 024).
AutopilotSection planning_of(PlanningPreset preset);

inline constexpr std::uint64_t maximum_seed = std::uint64_t{1} << 32;

/// A file that a flight reads beside its scenario: a plug-in (docs/integrate.md), what such a one imports, or
/// what another key names.
struct FileConfig {
  std::string file;
  std::string hash;
};

template <typename Visitor>
void visit_fields(Visitor& visit, FileConfig& read) {
  visit("file", read.file,
        "Name of the file: of a plug-in (a shared library, or Python), or of a file that the run read. A "
        "relative "
        "path is looked for beside the scenario file, then in the working directory.");
  visit("hash", read.hash,
        "Hash of the file's contents; empty: any. A run writes it, so that no other file is taken for it.");
}

struct Scenario {
  std::string name = "unnamed";
  std::uint64_t seed = 1000;
  std::string rig = "long";
  std::string course = "forest";
  std::vector<FileConfig> plugins, files;
  double time_limit_s = 30;
  Eigen::Vector3d wind_world_mps = Eigen::Vector3d::Zero();
  WindConfig wind;
  BandConfig band;
  ForestConfig forest;
  GoalpostsConfig goalposts;
  WindowsConfig windows;
  FenceConfig fence;
  PartConfigs plugged = parts().courses.configs();  ///< keys of the courses of plug-ins
  std::vector<ListedObstacle> obstacles;
  LaunchConfig launch;
  Airframe airframe;        ///< as the stack believes
  MismatchConfig mismatch;  ///< of the aircraft that flies
  ActuatorsConfig actuators;
  WorldSection world;
  CameraSection cameras;
  SensorSection sensors;
  std::vector<FaultConfig> faults;
  PerceptionSection perception;
  EstimationSection estimation;
  AutopilotSection autopilot = planning_of(PlanningPreset::economical);

  /// The mission as the stack knows it.
  Mission mission() const {
    return {0,
            goal_x_m(),
            forest.half_width_m,
            band.minimum_altitude_m,
            band.maximum_altitude_m,
            band.cruise_altitude_m};
  }
  /// The simulator's airframe, mismatch included. The stack never sees it.
  Airframe flown_airframe() const { return mismatched(airframe, mismatch); }
  /// Where the trees stand that wind.shelter_factor is about.
  ForestStand stand() const {
    if (course != "forest") return {};
    return {forest.clear_m, goal_x_m(), forest.half_width_m, forest.trunk_height_m};
  }
  /// The scene's settings with the course's switches in them.
  WorldConfig world_config() const {
    WorldConfig config = world.world;
    config.obstacles_visible = !forest.invisible;
    config.obstacles_tangible = !forest.intangible;
    return config;
  }
  double goal_x_m() const { return forest.clear_m + forest.length_m; }
  /// Where a flight goes on: beyond its sides and behind it a flight has left the course.
  Eigen::AlignedBox2d course_rectangle() const {
    return {Eigen::Vector2d(-forest.half_width_m, -forest.half_width_m),
            Eigen::Vector2d(goal_x_m(), forest.half_width_m)};
  }
  /// Frames looked at per second.
  double frame_rate_hz() const { return 1 / std::max(1.0 / cameras.rate_hz, perception.cost_s()); }
  /// Whether every frame reaches the stack. Then it is known beforehand which frames will be looked at.
  bool every_frame_arrives() const {
    return cameras.drop_probability == 0 && std::ranges::none_of(faults, [](const FaultConfig& fault) {
             return fault.sensor == FaultySensor::camera;
           });
  }
  std::uint64_t sensor_seed() const { return sensors.seed == 0 ? seed : sensors.seed; }
};

template <typename Visitor>
void visit_fields(Visitor& visit, BandConfig& band) {
  visit("minimum_altitude_m", band.minimum_altitude_m, -10.0, 100.0,
        "a flight that has climbed to this altitude ends when it falls below it");
  visit("maximum_altitude_m", band.maximum_altitude_m, 0.0, 500.0, "altitude above which a flight ends");
  visit("cruise_altitude_m", band.cruise_altitude_m, 0.0, 500.0,
        "target altitude of the planner when no obstacle is in the way");
}

template <typename Visitor>
void visit_fields(Visitor& visit, WorldSection& section) {
  VisitorWithout<Visitor, 2> without{visit, {"obstacles_visible", "obstacles_tangible"}};
  visit_fields(without, section.world);
}

template <typename Visitor>
void visit_fields(Visitor& visit, CameraSection& section) {
  visit_fields(visit, section.cameras);
  visit("rate_hz", section.rate_hz, 1, 1200,
        "stereo pairs per second; must divide 1200 (Barry & Tedrake 2015: 120 Hz) | Barry & Tedrake 2015");
  visit("latency_s", section.latency_s, 0.0, 0.4,
        "Time from the end of the exposure until the stack receives the frame: a setting, never a measured "
        "time. A frame's timestamp is the middle of its left exposure.");
  visit("drop_probability", section.drop_probability, 0.0, 1.0,
        "probability that a frame is lost, independently for each frame");
  visit("raw", section.raw,
        "Gives the stack raw (distorted, unrectified) images. It rectifies them with the calibration "
        "raw/NAME.xml in the folder of the rig file NAME.yaml (models/rigs/raw).");
  visit("raw_unit_m", section.raw_unit_m, 0.0001, 1000.0,
        "unit of length in the calibration file that cameras.raw reads; 0.01 (cm) for rig paper");
}

template <typename Visitor>
void visit_fields(Visitor& visit, SensorSection& section) {
  visit("seed", section.seed, std::uint64_t{0}, maximum_seed,
        "seed of the noise of all sensors and cameras; 0: the scenario's seed");
  visit("grade", section.grade, sensor_grade_names,
        "Quality class that sets the defaults of all sensors keys. ideal: no errors; nominal: white noise, "
        "constant biases, barometer drift; consumer: all errors of real parts; rough: three times those. | "
        "docs/sensors.md");
  visit_fields(visit, section.sensors);
}

template <typename Visitor>
void visit_fields(Visitor& visit, PerceptionSection& section) {
  visit("detector", section.detector, parts().detectors.names(),
        "Obstacle detector. true_depth gets exact depths from the simulator, none detects nothing; neither "
        "looks at images.");
  visit("preset", section.preset, pushbroom_preset_names,
        "Parameter set for perception.pushbroom and perception.depths_m; keys given there win. tuned: "
        "numbers and depths tuned for the rig; woods: tuned in woods; robust: before tuning; original: the "
        "original aircraft's.");
  visit("depths_m", section.pushbroom.depths_m, 0.1, 1000.0,
        "Depths at which the pushbroom detector looks for obstacles; empty: only the detection depth in the "
        "rig's file. The presets `tuned` and `woods` set two for the rig `paper`.");
  visit("pushbroom", section.pushbroom);
  visit("stereo_bm", section.stereo_bm);
  visit("stereo_sgbm", section.stereo_sgbm);
  visit("full_stereo", section.full_stereo);
  visit("compute", section.compute);
  visit_parts(visit, section.plugged);
}

template <typename Visitor>
void visit_fields(Visitor& visit, EstimationSection& section) {
  visit("source", section.source, parts().state_sources.names(),
        "Source of the aircraft's state for the flight stack. filter: the estimator; dead_reckoning: pitot "
        "and gyro alone; truth: the simulator's exact state.");
  visit(
      "preset", section.preset, filter_preset_names,
      "Preset values of estimation.filter; keys that the scenario gives in estimation.filter override them. "
      "tuned: the default; original: the original aircraft's filter; windy: estimates wind and gusts, too.");
  visit("filter", section.filter);
  visit("dead_reckoning", section.dead_reckoning);
  visit_parts(visit, section.plugged);
}

template <typename Visitor>
void visit_fields(Visitor& visit, AutopilotSection& section) {
  visit(
      "preset", section.preset, planning_preset_names,
      "Preset values of the planning keys; keys that the scenario gives in autopilot override them. "
      "economical: plans when a new obstacle comes near the plan, else seldom; thorough: plans continually.");
  visit("method", section.method, parts().planners.names(),
        "Planner. sst, rrt, est: OMPL grows a tree of manoeuvres with the method of this name; library: the "
        "best of a list of manoeuvres; straight: straight on, through everything.");
  visit("actions", section.actions,
        "File with the controls of a flight that somebody else flew, which are flown again in place of the "
        "planner's; empty: the planner flies. A relative path is looked for beside the scenario file, then "
        "in the working directory. | docs/python.md");
  visit("replan_rate_hz", section.replan_rate_hz, 1, 1200,
        "highest rate at which the autopilot starts plans; must divide 1200");
  visit_fields(visit, section.autopilot);
  visit("library", section.library);
  visit_parts(visit, section.plugged);
}

template <typename Visitor>
void visit_fields(Visitor& visit, Scenario& scenario) {
  visit("name", scenario.name,
        "name of the run, whose folder is runs/NAME-SEED; letters, digits, '-', '_' and '.'");
  visit("seed", scenario.seed, std::uint64_t{0}, maximum_seed,
        "seed of course, wind and the planner's search; also of sensor noise if sensors.seed is 0");
  visit("rig", scenario.rig,
        "stereo rig: a name in models/rigs, or the path of a rig file relative to the scenario file");
  visit("course", scenario.course, parts().courses.names(),
        "kind of course; the keys that begin with the same word describe it");
  visit("plugins", scenario.plugins);
  visit("files", scenario.files);
  visit("time_limit_s", scenario.time_limit_s, 0.1, 600.0, "simulated time after which a flight ends");
  visit("wind_world_mps", scenario.wind_world_mps, -20.0, 20.0,
        "velocity of the mean wind, in world axes, at wind.reference_height_m");
  visit("wind", scenario.wind);
  visit("band", scenario.band);
  visit("forest", scenario.forest);
  visit("goalposts", scenario.goalposts);
  visit("windows", scenario.windows);
  visit("fence", scenario.fence);
  visit_parts(visit, scenario.plugged);
  visit("obstacles", scenario.obstacles);
  visit("launch", scenario.launch);
  visit("airframe", scenario.airframe);
  visit("mismatch", scenario.mismatch);
  visit("actuators", scenario.actuators);
  visit("world", scenario.world);
  visit("cameras", scenario.cameras);
  visit("sensors", scenario.sensors);
  visit("faults", scenario.faults);
  visit("perception", scenario.perception);
  visit("estimation", scenario.estimation);
  visit("autopilot", scenario.autopilot);
}

}  // namespace understory
