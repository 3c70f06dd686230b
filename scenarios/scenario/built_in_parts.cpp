#include "scenarios/parts/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimation/dead_reckoning.hpp"
#include "estimation/filter.hpp"
#include "perception/full_stereo/full_stereo.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "perception/rectification/rectify.hpp"
#include "planning/avoidance_planner.hpp"
#include "planning/planners.hpp"
#include "scenarios/course/inventory.hpp"
#include "scenarios/parts/checked_parts.hpp"
#include "scenarios/parts/oracles.hpp"
#include "scenarios/parts/synthetic_detector.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

std::vector<double> pushbroom_depths_m(const Scenario& scenario, const StereoRig& rig) {
  const std::vector<double> depths_m = stated_depths_m(scenario.perception.pushbroom(), rig);
  return depths_m.empty() ? std::vector{rig.detection_depth_m} : depths_m;
}

std::vector<double> synthetic_depths_m(const Scenario& scenario, const StereoRig&) {
  return scenario.perception.detectors.of<SyntheticConfig>("synthetic").depths_m;
}

double pushbroom_cost_s(const PerceptionSection& perception) {
  const PushbroomConfig& config = perception.pushbroom();
  const std::size_t depths = std::max({std::size_t{1}, config.depths_m.size(), config.disparities_px.size()});
  const double overlap =
      std::pow(5.0 / config.stride_px, 1.5);  // 2.08 at 3 px, 4.16 at 2 (docs/benchmarks.md)
  return perception.compute.pushbroom_s * overlap *
         (1 + perception.compute.more_depths * (static_cast<double>(depths) - 1));
}

std::unique_ptr<ObstacleDetector> pushbroom_of(const FlightContext& context) {
  const auto& config = own_config<PushbroomConfig>(context);
  check_depths(config, context.rig.rig, "perception.depths_m", "perception.pushbroom");
  return std::make_unique<PushbroomStereo>(context.rig, config);
}

template <typename Config>
std::unique_ptr<ObstacleDetector> full_stereo_of(const FlightContext& context) {
  auto detector = std::make_unique<FullStereoDetector>(context.rig.rig, own_config<Config>(context),
                                                       context.scenario.perception.full_stereo);
  if (!context.rig.calibration) return detector;
  return std::make_unique<RectifyingDetector>(*context.rig.calibration, std::move(detector));
}

std::unique_ptr<ObstacleDetector> synthetic_of(const FlightContext& context) {
  const FullStereoCrop& crop = context.scenario.perception.full_stereo;
  const auto& config = own_config<SyntheticConfig>(context);
  PushbroomConfig looks;  // its depths alone are checked
  looks.depths_m = config.depths_m;
  check_depths(looks, context.rig.rig, "perception.synthetic.depths_m", "perception.synthetic");
  return std::make_unique<SyntheticDetector>(context.rig.rig, context.obstacles, context.truth, config,
                                             DepthInterval{crop.minimum_depth_m, crop.maximum_depth_m},
                                             context.seed);
}

std::string stereo_bm_fault(const StereoBmConfig& config, const Scenario&) {
  if (config.window_px % 2 == 0) return "window_px: must be an odd number";
  if (config.prefilter_size_px % 2 == 0) return "prefilter_size_px: must be an odd number";
  return config.disparities % 16 == 0 ? "" : "disparities: must be a multiple of 16";
}

std::string stereo_sgbm_fault(const StereoSgbmConfig& config, const Scenario&) {
  if (config.window_px % 2 == 0) return "window_px: must be an odd number";
  if (config.disparities % 16 != 0) return "disparities: must be a multiple of 16";
  return config.smoothness_1 < config.smoothness_2 ? "" : "smoothness_1: must be less than smoothness_2";
}

std::string goalposts_fault(const GoalpostsConfig& config, const Scenario&) {
  return config.pass_minimum_m <= config.pass_maximum_m
             ? ""
             : "pass_minimum_m: must be at most goalposts.pass_maximum_m";
}

std::string fence_fault(const FenceConfig& config, const Scenario& scenario) {
  const double across_from_m = scenario.goal_x_m() - config.first_across_m;
  const double fences = std::max(0.0, std::ceil(across_from_m / config.across_apart_m));
  const double across_m = fences * 2 * (config.reach_m - 0.5 * config.opening_m);
  const double palings = (across_m + std::max(0.0, across_from_m)) / config.spacing_m;
  if (scenario.course == "fence" && palings > maximum_obstacles)
    return fmt::format("spacing_m: a fence may have at most {} palings, this one would have about {:.0f}",
                       maximum_obstacles, palings);
  return config.opening_m < 2 * config.reach_m ? "" : "opening_m: must be less than twice fence.reach_m";
}

void add_detectors(PartList<DetectorPart>& detectors) {
  detectors.add({.name = "pushbroom",
                 .meaning = "pushbroom stereo at the depths of perception.depths_m",
                 .make = pushbroom_of,
                 .cost_s = pushbroom_cost_s,
                 .depths_m = pushbroom_depths_m},
                tuned_pushbroom("long"));
  detectors.add({.name = "stereo_bm",
                 .meaning = "OpenCV's block matcher over all depths",
                 .make = full_stereo_of<StereoBmConfig>,
                 .cost_s = [](const PerceptionSection& section) { return section.compute.stereo_bm_s; }},
                StereoBmConfig(), stereo_bm_fault);
  detectors.add({.name = "stereo_sgbm",
                 .meaning = "OpenCV's semi-global matcher over all depths",
                 .make = full_stereo_of<StereoSgbmConfig>,
                 .cost_s = [](const PerceptionSection& section) { return section.compute.stereo_sgbm_s; }},
                StereoSgbmConfig(), stereo_sgbm_fault);
  detectors.add({.name = "true_depth",
                 .meaning = "exact depth from the simulator, at the depths of perception.depths_m",
                 .make =
                     [](const FlightContext& context) {
                       const StereoRig& rig = context.rig.rig;
                       return std::make_unique<TrueDepth>(
                           rig, context.obstacles, context.truth,
                           intervals_around(pushbroom_depths_m(context.scenario, rig), rig));
                     },
                 .needs_images = false,
                 .depths_m = pushbroom_depths_m});
  detectors.add({.name = "synthetic",
                 .meaning = "hits made from the truth, with the depths, misses and errors that its keys say",
                 .make = synthetic_of,
                 .needs_images = false,
                 .depths_m = synthetic_depths_m},
                SyntheticConfig());
  detectors.add({.name = "none",
                 .meaning = "detects nothing: the blind aircraft",
                 .make = [](const FlightContext&) { return std::make_unique<NoDetector>(); },
                 .needs_images = false});
}

void add_state_sources(PartList<StateSourcePart>& sources) {
  sources.add({.name = "filter",
               .meaning = "the error-state Kalman filter",
               .make =
                   [](const FlightContext& context) {
                     return std::make_unique<Filter>(own_config<FilterConfig>(context));
                   }},
              FilterConfig());
  sources.add({.name = "dead_reckoning",
               .meaning = "pitot and gyro alone, integrated",
               .make =
                   [](const FlightContext& context) {
                     return std::make_unique<DeadReckoning>(own_config<DeadReckoningConfig>(context),
                                                            context.scenario.estimation.filter());
                   }},
              DeadReckoningConfig());
  sources.add(
      {.name = "truth", .meaning = "the simulator's exact state", .make = [](const FlightContext& context) {
         return std::make_unique<TrueState>(context.truth);
       }});
}

template <TreeMaker tree>
std::unique_ptr<Planner> tree_planner_of(const PlannerPartContext& context) {
  return std::make_unique<AvoidancePlanner>(context, tree);
}

void add_planners(PartList<PlannerPart>& planners) {
  planners.add({.name = "sst",
                .meaning = "a tree of manoeuvres that SST grows, which keeps cheap ways",
                .make = tree_planner_of<sst_tree>});
  planners.add({.name = "rrt",
                .meaning = "a tree of manoeuvres that RRT grows, towards random states",
                .make = tree_planner_of<rrt_tree>});
  planners.add({.name = "est",
                .meaning = "a tree of manoeuvres that EST grows, where it has few nodes",
                .make = tree_planner_of<est_tree>});
  planners.add({.name = "library",
                .meaning = "the manoeuvre with the largest clearance from a list",
                .make =
                    [](const PlannerPartContext& context) {
                      return library_planner(context, own_config<ManoeuvreLibraryConfig>(context));
                    }},
               ManoeuvreLibraryConfig());
  planners.add({.name = "straight",
                .meaning = "straight on, through everything",
                .make = [](const PlannerPartContext& context) { return straight_planner(context); }});
}

Planted planted_forest(const CourseContext& context) {
  const ForestConfig& forest = context.scenario.forest;
  if (forest.trees_file.empty()) return {random_forest(forest, context.seed)};
  return place_stems(stems_of(forest), forest, context.seed);
}

void add_courses(PartList<CoursePart>& courses) {
  courses.add({.name = "forest", .meaning = "random or measured trees", .make = planted_forest});
  courses.add({.name = "goalposts",
               .meaning = "two uprights and a crossbar",
               .make =
                   [](const CourseContext& context) {
                     return Planted{goalposts(own_config<GoalpostsConfig>(context), context.seed)};
                   }},
              GoalpostsConfig(), goalposts_fault);
  courses.add(
      {.name = "clear", .meaning = "no obstacles", .make = [](const CourseContext&) { return Planted{}; }});
  courses.add({.name = "windows",
               .meaning = "a facade of equal windows behind the goal",
               .make =
                   [](const CourseContext& context) {
                     return Planted{windows(own_config<WindowsConfig>(context), context.scenario.goal_x_m())};
                   }},
              WindowsConfig());
  courses.add({.name = "fence",
               .meaning = "fences of equal palings beside and across the way",
               .make =
                   [](const CourseContext& context) {
                     return Planted{fence(own_config<FenceConfig>(context), context.scenario.goal_x_m())};
                   }},
              FenceConfig(), fence_fault);
}

Parts built_in_parts() {
  using In = const Scenario&;
  Parts parts{PartList<DetectorPart>([](In one) -> const PartConfigs& { return one.perception.detectors; }),
              PartList<StateSourcePart>([](In one) -> const PartConfigs& { return one.estimation.sources; }),
              PartList<PlannerPart>([](In one) -> const PartConfigs& { return one.autopilot.planners; }),
              PartList<CoursePart>([](In one) -> const PartConfigs& { return one.courses; })};
  add_detectors(parts.detectors);
  add_state_sources(parts.state_sources);
  add_planners(parts.planners);
  add_courses(parts.courses);
  return parts;
}

}  // namespace

Parts& parts() {
  static Parts all = built_in_parts();
  return all;
}

}  // namespace understory
