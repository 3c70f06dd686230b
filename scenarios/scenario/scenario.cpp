#include "scenarios/scenario/scenario.hpp"

#include "estimation/filter_config.hpp"

namespace understory {

FilterConfig& EstimationSection::filter() { return sources.of<FilterConfig>("filter"); }
const FilterConfig& EstimationSection::filter() const { return sources.of<FilterConfig>("filter"); }

PlanCost ComputeConfig::plan_cost(double imu_rate_hz) const {
  if (!enabled) return {};
  const double stretch = factor / (1 - std::min(0.9, factor * filter_s * imu_rate_hz));
  return {stretch * plan_point_s, stretch * plan_step_s};
}

void visit_fields(FieldVisitor& visit, ComputeConfig& config) {
  visit(
      "enabled", config.enabled,
      "simulates the time that the aircraft's computer needs for each stereo pair and for each plan; false: "
      "detection takes no time, and a plan takes autopilot.plan_latency_s");
  visit("factor", config.factor, 0.001, 1000.0,
        "Ratio of the time on the aircraft's computer to the time on one thread of the machine that measured "
        "the other perception.compute keys. 8.3: the original detector takes 1.0 ms on that machine, and on "
        "a 1.7 GHz quad ARM Cortex-A9 it filled the 8.3 ms of a frame at 120 Hz. A larger factor is a slower "
        "computer. | Barry & Tedrake 2015");
  visit(
      "pushbroom_s", config.pushbroom_s, 0.0, 1.0,
      "pushbroom detector's time per pair at one depth with a stride of 5 px, rectification included, before "
      "compute.factor; with a smaller stride it is (5 / stride)^1.5 of this | "
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
  visit("plan_point_s", config.plan_point_s, 0.0, 0.001,
        "Time of a plan for each point in the map, before compute.factor. A plan is ready when the work that "
        "it "
        "counted is done, and not before autopilot.plan_latency_s. | docs/benchmarks.md");
  visit("plan_step_s", config.plan_step_s, 0.0, 0.001,
        "time of a plan for each step of the flight model, before compute.factor | docs/benchmarks.md");
  visit(
      "filter_s", config.filter_s, 0.0, 0.001,
      "time of the filter for each IMU sample, before compute.factor; it delays plans, which share its core "
      "and keep a tenth of it whatever the filter takes | docs/benchmarks.md");
}

void visit_fields(FieldVisitor& visit, FileConfig& read) {
  visit("file", read.file,
        "Name of the file: of a plug-in (a shared library, or Python), or of a file that the run read. A "
        "relative path is looked for beside the scenario file, then in the working directory.");
  visit("hash", read.hash,
        "Hash of the file's contents; empty: any. A run writes it, so that no other file is taken for it.");
}

void visit_fields(FieldVisitor& visit, BandConfig& band) {
  visit("minimum_altitude_m", band.minimum_altitude_m, -10.0, 100.0,
        "a flight that has climbed to this altitude ends when it falls below it");
  visit("maximum_altitude_m", band.maximum_altitude_m, 0.0, 500.0, "altitude above which a flight ends");
  visit("cruise_altitude_m", band.cruise_altitude_m, 0.0, 500.0,
        "Target altitude of the planner when no obstacle is in the way. Default on a course of over 100 m: "
        "4. | docs/decisions/035");
}

void visit_fields(FieldVisitor& visit, CameraSection& section) {
  visit_fields(visit, static_cast<CameraConfig&>(section));
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

void visit_fields(FieldVisitor& visit, SensorSection& section) {
  visit("seed", section.seed, std::uint64_t{0}, maximum_seed,
        "seed of the noise of all sensors and cameras; 0: the scenario's seed");
  visit("grade", section.grade, sensor_grade_names,
        "Quality class that sets the defaults of all sensors keys. ideal: no errors; nominal: white noise, "
        "constant biases, barometer drift; consumer: all errors of real parts; rough: three times those. | "
        "docs/sensors.md");
  visit_fields(visit, static_cast<SensorsConfig&>(section));
}

void visit_fields(FieldVisitor& visit, PerceptionSection& section) {
  visit(
      "detector", section.detector, parts().detectors.names(),
      "Obstacle detector. true_depth gets exact depths from the simulator, synthetic gets them with faults, "
      "none detects nothing; these look at no images.");
  visit("preset", section.preset, pushbroom_preset_names,
        "Parameter set for perception.pushbroom and perception.depths_m; keys given there win. tuned: "
        "numbers and depths tuned for the rig; woods: tuned in woods; robust: before tuning; original: the "
        "original aircraft's.");
  visit("depths_m", section.pushbroom().depths_m, 0.1, 1000.0,
        "Depths at which the detectors pushbroom and true_depth look for obstacles; empty: only the "
        "detection depth in the rig's file. The presets `tuned` and `woods` set two for the rig `paper`.");
  visit_parts(visit, section.detectors, false);
  visit("full_stereo", section.full_stereo);
  visit("compute", section.compute);
  visit_parts(visit, section.detectors, true);
}

void visit_fields(FieldVisitor& visit, EstimationSection& section) {
  visit("source", section.source, parts().state_sources.names(),
        "Source of the aircraft's state for the flight stack. filter: the estimator; dead_reckoning: pitot "
        "and gyro alone; truth: the simulator's exact state.");
  visit(
      "preset", section.preset, filter_preset_names,
      "Preset values of estimation.filter; keys that the scenario gives in estimation.filter override them. "
      "tuned: the default; original: the original aircraft's filter; windy: estimates wind and gusts, too.");
  visit_parts(visit, section.sources);
}

void visit_fields(FieldVisitor& visit, AutopilotSection& section) {
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
  visit("seed", section.seed, std::uint64_t{0}, maximum_seed,
        "seed of the planner's random numbers; 0: the scenario's seed");
  visit("replan_rate_hz", section.replan_rate_hz, 1, 1200,
        "highest rate at which the autopilot starts plans; must divide 1200");
  visit_fields(visit, static_cast<AutopilotConfig&>(section));
  visit_parts(visit, section.planners);
}

void visit_fields(FieldVisitor& visit, IdealConfig& ideal) {
  visit("parts", ideal.parts,
        "some of detection, sight, map, state, latency, search and tracking: parts of the stack that "
        "are replaced by ideal ones from from_s on. Detection finds every obstacle at the depths in use and "
        "nothing else; sight finds all that stands within 40 m; map forgets and filters nothing away; state "
        "is the truth; latency is none; search is 20 times as long; tracking flies the plan as the planner "
        "predicts it. The command explain uses it. | docs/explain.md");
  visit("from_s", ideal.from_s, 0.0, 600.0,
        "simulated time from which the parts are ideal and noise is redrawn");
  visit("redraw", ideal.redraw, std::uint64_t{0}, maximum_seed,
        "seed from which the noise of sensors and cameras and the planner's random numbers are drawn anew at "
        "from_s; 0: they go on as they were");
  visit("hits", ideal.hits,
        "File with the hits of an earlier flight until from_s, as explain writes it: images of that time are "
        "not drawn. It requires redraw.");
}

void visit_fields(FieldVisitor& visit, Scenario& scenario) {
  visit("name", scenario.name,
        "name of the run, whose folder is runs/NAME-SEED; letters, digits, '-', '_' and '.'");
  visit("seed", scenario.seed, std::uint64_t{0}, maximum_seed,
        "seed of course and wind; also of sensor noise if sensors.seed is 0, and of the planner's search if "
        "autopilot.seed is 0");
  visit("rig", scenario.rig,
        "stereo rig: a name in models/rigs, or the path of a rig file relative to the scenario file");
  visit("course", scenario.course, parts().courses.names(),
        "kind of course; the keys that begin with the same word describe it");
  visit("plugins", scenario.plugins);
  visit("files", scenario.files);
  visit("time_limit_s", scenario.time_limit_s, 0.1, 600.0,
        "Simulated time after which a flight ends. Default on a course of over 100 m: twice as long as the "
        "way to the goal takes at the cruise speed.");
  visit("wind_world_mps", scenario.wind_world_mps, -20.0, 20.0,
        "velocity of the mean wind, in world axes, at wind.reference_height_m");
  visit("wind", scenario.wind);
  visit("band", scenario.band);
  visit("forest", scenario.forest);
  visit_parts(visit, scenario.courses);
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
  visit("ideal", scenario.ideal);
}

}  // namespace understory
