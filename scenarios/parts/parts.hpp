#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "estimation/state_source.hpp"
#include "perception/io/calibration/calibration_file.hpp"
#include "perception/obstacle_detector.hpp"
#include "planning/planner.hpp"
#include "scenarios/config/any_config.hpp"
#include "scenarios/course/courses.hpp"

/// The parts that a scenario chooses by name: detector, state source, planner, and course. Ours and those of
/// plug-ins are registered in the same way, with their keys.
namespace understory {

class TruthHistory;
struct PerceptionSection;
struct Scenario;

/// A part under its name. `Context` is what it is made from; all of that outlives the part.
template <typename Made, typename Context>
struct Part {
  using MadeFrom = Context;

  std::string name;     ///< letters a-z, digits and '_'
  std::string meaning;  ///< one sentence, for lists
  std::function<Made(const Context&)> make;
  std::shared_ptr<const AnyConfig> defaults = nullptr;  ///< its own keys, below its name; null: none
  /// What contradicts what among its keys: "window_px: must be an odd number"; empty: nothing.
  std::function<std::string(const AnyConfig&, const Scenario&)> fault = nullptr;
  std::string plugin = "";  ///< file that it came from; empty: ours

  // Properties of a detector that are needed before it is made; parts of other kinds keep the defaults.
  bool needs_images = true;  ///< images that nobody needs are not rendered
  /// Time that one pair costs the measuring machine (docs/thesis.md), before perception.compute.factor.
  std::function<double(const PerceptionSection&)> cost_s = nullptr;
  /// Depths that it compares, m; none: all depths that it can see.
  std::function<std::vector<double>(const Scenario&, const StereoRig&)> depths_m = nullptr;
};

/// What a detector or a state source is made from.
struct FlightContext {
  const Scenario& scenario;
  const CalibratedRig& rig;
  const std::vector<Obstacle>& obstacles;  ///< the truth, for oracles
  const TruthHistory& truth;               ///< the truth, for oracles
  std::uint64_t seed = 0;                  ///< of its random generators
  const AnyConfig* config = nullptr;       ///< the part's own keys; PartList sets it
};

/// What a planner is made from.
struct PlannerPartContext : PlannerContext {
  const Scenario& scenario;
  const AnyConfig* config = nullptr;  ///< the part's own keys; PartList sets it
};

/// What a course is made from.
struct CourseContext {
  const Scenario& scenario;
  std::uint64_t seed = 0;             ///< the scenario's
  const AnyConfig* config = nullptr;  ///< the part's own keys; PartList sets it
};

using DetectorPart = Part<std::unique_ptr<ObstacleDetector>, FlightContext>;
using StateSourcePart = Part<std::unique_ptr<StateSource>, FlightContext>;
using PlannerPart = Part<std::unique_ptr<Planner>, PlannerPartContext>;
/// Makes the obstacles. World frame: the launch is near x = 0, y = 0, the flight goes along x to the goal
/// plane (Scenario::goal_x_m), the ground is z = 0. Equal contexts must give equal obstacles.
using CoursePart = Part<Planted, CourseContext>;

/// The config struct of a part within its factory.
template <typename Config, typename Context>
const Config& own_config(const Context& context) {
  return static_cast<const TypedConfig<Config>*>(context.config)->config;
}

template <typename One>
class PartList {
 public:
  /// `configs_of`: where a scenario holds the keys of these parts.
  explicit PartList(const PartConfigs& (*configs_of)(const Scenario&)) : configs_of_(configs_of) {}

  /// Adds a part. Throws std::invalid_argument where the name is taken or not a plain word.
  One& add(One part) {
    constexpr const char* letters = "abcdefghijklmnopqrstuvwxyz0123456789_";
    if (part.name.empty() || part.name.find_first_not_of(letters) != std::string::npos)
      throw std::invalid_argument("the name '" + part.name + "' must be letters a-z, digits and '_'");
    if (find(part.name) != nullptr) throw std::invalid_argument("the name '" + part.name + "' is taken");
    if (!part.make) throw std::invalid_argument("'" + part.name + "' must have a function that makes it");
    if (part.defaults) {
      require_sound_keys(part.name, *part.defaults);
      give_own_keys(part);
    }
    return parts_.emplace_back(std::move(part));
  }
  /// Adds a part with keys of its own: `defaults` has a visit_fields(), and the keys are below the part's
  /// name. `fault`: see Part.
  template <typename Config>
  One& add(One part, Config defaults,
           std::function<std::string(const std::type_identity_t<Config>&, const Scenario&)> fault = nullptr) {
    part.defaults = std::make_shared<const TypedConfig<Config>>(std::move(defaults));
    if (fault)
      part.fault = [fault](const AnyConfig& config, const Scenario& scenario) {
        return fault(static_cast<const TypedConfig<Config>&>(config).config, scenario);
      };
    return add(std::move(part));
  }
  /// Null where there is none of this name.
  const One* find(std::string_view name) const {
    for (const One& part : parts_)
      if (part.name == name) return &part;
    return nullptr;
  }
  const std::deque<One>& all() const { return parts_; }
  std::deque<One>& all() { return parts_; }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const One& part : parts_) names.push_back(part.name);
    return names;
  }
  /// The default keys of all parts that have some.
  PartConfigs configs() const {
    PartConfigs configs;
    for (const One& part : parts_)
      if (part.defaults) configs.entries.push_back({part.name, part.defaults->clone(), !part.plugin.empty()});
    return configs;
  }

 private:
  /// Whoever makes the part, it gets its own keys: another part may make it and wrap it.
  void give_own_keys(One& part) const {
    using Context = typename One::MadeFrom;
    part.make = [make = part.make, name = part.name, configs_of = configs_of_](const Context& context) {
      Context own = context;
      own.config = configs_of(context.scenario).find(name);
      return make(own);
    };
  }

  const PartConfigs& (*configs_of_)(const Scenario&);
  std::deque<One> parts_;  ///< a part that is being made may add another
};

/// Everything that a scenario can name.
struct Parts {
  PartList<DetectorPart> detectors;         ///< perception.detector
  PartList<StateSourcePart> state_sources;  ///< estimation.source
  PartList<PlannerPart> planners;           ///< autopilot.method
  PartList<CoursePart> courses;             ///< course
};

/// Ours, and those of the plug-ins loaded until now. There is one table for a process, which only grows: a
/// scenario holds names, and a flight looks them up when it is made.
Parts& parts();

}  // namespace understory
