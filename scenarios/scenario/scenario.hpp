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

class FieldVisitor;
struct FilterConfig;

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

/// Altitudes within which the flight must stay after it has climbed into them; leaving them ends it. A flight
/// over the trees or along the ground would prove nothing.
struct BandConfig {
  double minimum_altitude_m = 1;
  double maximum_altitude_m = 6;
  double cruise_altitude_m = 4.5;
};

struct CameraSection : CameraConfig {
  int rate_hz = 120;
  double latency_s = 0.008;
  double drop_probability = 0;
  bool raw = false;
  double raw_unit_m = 1;
};

struct SensorSection : SensorsConfig {
  std::uint64_t seed = 0;
  SensorGrade grade = SensorGrade::nominal;
};

/// What a pair, a plan and a sample cost the aircraft's computer, in simulated time, never measured during a
/// flight. Off: every frame is looked at without delay. Vision has a core of its own, as on the original
/// aircraft; planner and filter share another. docs/thesis.md has the source of the numbers.
struct ComputeConfig {
  bool enabled = false;
  double factor = 8.3;
  double pushbroom_s = 0.0010;
  double more_depths = 0.4;
  double stereo_bm_s = 0.0090;
  double stereo_sgbm_s = 0.0127;
  double plan_point_s = 6.5e-8;
  double plan_step_s = 5e-7;
  double filter_s = 2e-6;

  /// Zero where it is not enabled.
  PlanCost plan_cost(double imu_rate_hz) const;
};

struct PerceptionSection {
  std::string detector = "pushbroom";
  PushbroomPreset preset = PushbroomPreset::tuned;
  PartConfigs detectors = parts().detectors.configs();
  FullStereoCrop full_stereo;
  ComputeConfig compute;

  PushbroomConfig& pushbroom() { return detectors.of<PushbroomConfig>("pushbroom"); }
  const PushbroomConfig& pushbroom() const { return detectors.of<PushbroomConfig>("pushbroom"); }
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
  PartConfigs sources = parts().state_sources.configs();

  FilterConfig& filter();
  const FilterConfig& filter() const;
};

struct AutopilotSection : AutopilotConfig {
  std::uint64_t seed = 0;
  PlanningPreset preset = PlanningPreset::economical;
  std::string method = "sst";
  std::string actions;
  int replan_rate_hz = 120;
  PartConfigs planners = parts().planners.configs();
};

/// The numbers that a preset stands for (docs/decisions/015, 024).
AutopilotSection planning_of(PlanningPreset preset);

/// Parts of the stack that are ideal from a moment on, and noise that is drawn anew then (docs/explain.md).
struct IdealConfig {
  std::vector<std::string> parts;
  double from_s = 0;
  std::uint64_t redraw = 0;
  std::string hits;
  /// Whether it changes anything.
  bool acts() const { return !parts.empty() || redraw != 0; }
};

/// What `ideal.parts` may name.
inline constexpr std::array<std::string_view, 7> ideal_part_names{"detection", "sight",  "map",     "state",
                                                                  "latency",   "search", "tracking"};

inline constexpr std::uint64_t maximum_seed = std::uint64_t{1} << 32;

/// A file that a flight reads beside its scenario: a plug-in (docs/integrate.md), a file that a plug-in
/// imports, or a file that another key names.
struct FileConfig {
  std::string file;
  std::string hash;
};

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
  ForestConfig forest;  ///< its length and its sides hold for all courses
  PartConfigs courses = parts().courses.configs();
  std::vector<ListedObstacle> obstacles;
  LaunchConfig launch;
  Airframe airframe;        ///< as the stack believes
  MismatchConfig mismatch;  ///< of the aircraft that flies
  ActuatorsConfig actuators;
  WorldConfig
      world;  ///< whether obstacles are seen or felt is the course's business: forest.invisible, .intangible
  CameraSection cameras;
  SensorSection sensors;
  std::vector<FaultConfig> faults;
  PerceptionSection perception;
  EstimationSection estimation;
  AutopilotSection autopilot = planning_of(PlanningPreset::economical);
  IdealConfig ideal;

  /// A course of over 100 m asks how far the aircraft flies between crashes: only contact, the altitude band
  /// and time end its flights, and GPS keeps them among the trees (docs/limits.md).
  bool is_long() const { return goal_x_m() > 100; }
  /// The mission as the stack gets it. On a long course trees stand on both sides of the way that it names,
  /// so that no error of GPS leads out of the forest.
  Mission mission() const {
    return {0,
            goal_x_m(),
            is_long() ? 0.7 * forest.half_width_m : forest.half_width_m,
            band.minimum_altitude_m,
            band.maximum_altitude_m,
            band.cruise_altitude_m};
  }
  /// The simulator's airframe, mismatch included. The stack never sees it.
  Airframe flown_airframe() const { return mismatched(airframe, mismatch); }
  /// Where the trees stand to which wind.shelter_factor applies.
  ForestStand stand() const {
    if (course != "forest") return {};
    return {forest.clear_m, goal_x_m(), forest.half_width_m, forest.trunk_height_m};
  }
  /// The scene's settings with the course's switches in them.
  WorldConfig world_config() const {
    WorldConfig config = world;
    config.obstacles_visible = !forest.invisible;
    config.obstacles_tangible = !forest.intangible;
    return config;
  }
  double goal_x_m() const { return forest.clear_m + forest.length_m; }
  /// The course's ground. Beyond its sides and behind it a flight has left the course, unless it is long.
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
  std::uint64_t planner_seed() const { return autopilot.seed == 0 ? seed : autopilot.seed; }
};

void visit_fields(FieldVisitor& visit, CameraSection& section);
void visit_fields(FieldVisitor& visit, SensorSection& section);
void visit_fields(FieldVisitor& visit, PerceptionSection& section);
void visit_fields(FieldVisitor& visit, AutopilotSection& section);
void visit_fields(FieldVisitor& visit, Scenario& scenario);

}  // namespace understory
