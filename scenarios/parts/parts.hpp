#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/config/field_visitor.hpp"

/// The parts of the flight stack that a scenario chooses by name: what sees, what knows where the aircraft is, what
/// decides where it goes. Ours and those of plug-ins are registered alike.
namespace understory {

class ObstacleDetector;
class Planner;
class StateSource;
class TruthHistory;
struct Airframe;
struct CalibratedRig;
struct FullStereoCrop;
struct Obstacle;
struct PlannerContext;

/// What a detector may be made from. All outlive it.
struct DetectorContext {
  const CalibratedRig& rig;
  const FullStereoCrop& full_stereo;       ///< perception.full_stereo: what of a depth map becomes hits
  const std::vector<Obstacle>& obstacles;  ///< of the course; for oracles
  const TruthHistory& truth;               ///< for oracles
  std::uint64_t seed;                      ///< for its generators
};

/// What a state source may be made from. All outlive it.
struct StateSourceContext {
  const Airframe& airframe;   ///< as the stack believes it to be
  const TruthHistory& truth;  ///< for oracles
  std::uint64_t seed;         ///< for its generators
};

/// A part under its name.
template <typename Made, typename Context>
struct Part {
  std::string name;                           ///< letters a-z, digits and _
  std::shared_ptr<const AnyConfig> defaults;  ///< its keys stand under its name; null: it has none
  std::function<std::unique_ptr<Made>(AnyConfig*, const Context&)> make;
  bool looks = true;   ///< a detector: whether it looks at images; those nobody looks at are not rendered
  std::string plugin;  ///< the file it came from; empty: ours
};

template <typename Made, typename Context>
class PartList {
 public:
  /// Adds a part without keys. `make(context)` gives a std::unique_ptr.
  template <typename Make>
  Part<Made, Context>& add(std::string name, Make make) {
    return put({std::move(name), nullptr,
                [make = std::move(make)](AnyConfig*, const Context& context) { return make(context); },
                true, plugin_});
  }
  /// Adds one with the keys of `Config`, which has a visit_fields() as any config struct of the house:
  /// `make(config, context)`.
  template <typename Config, typename Make>
  Part<Made, Context>& add(std::string name, Make make, Config defaults = {}) {
    return put({std::move(name), std::make_shared<TypedConfig<Config>>(std::move(defaults)),
                [make = std::move(make)](AnyConfig* config, const Context& context) {
                  return make(static_cast<TypedConfig<Config>*>(config)->config, context);
                },
                true, plugin_});
  }
  /// Null where there is none of this name.
  const Part<Made, Context>* find(std::string_view name) const {
    for (const Part<Made, Context>& part : parts_)
      if (part.name == name) return &part;
    return nullptr;
  }
  const std::vector<Part<Made, Context>>& parts() const { return parts_; }
  /// The file that parts added from now on come from.
  void come_from(std::string plugin) { plugin_ = std::move(plugin); }

 private:
  Part<Made, Context>& put(Part<Made, Context> part) {
    if (find(part.name) != nullptr) throw std::invalid_argument(part.name + ": expected a name that is not in use");
    if (part.name.empty() || part.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
      throw std::invalid_argument(part.name + ": expected a name of letters a-z, digits and _");
    return parts_.emplace_back(std::move(part));
  }

  std::vector<Part<Made, Context>> parts_;
  std::string plugin_;
};

/// Everything that can be named.
struct Parts {
  PartList<ObstacleDetector, DetectorContext> detectors;      ///< perception.detector
  PartList<StateSource, StateSourceContext> state_sources;    ///< estimation.source
  PartList<Planner, PlannerContext> planners;                 ///< autopilot.planning
};

/// Ours.
const std::shared_ptr<const Parts>& built_in_parts();

/// The keys of each part of a list, under its name. Copies are deep.
class PartConfigs {
 public:
  struct Entry {
    std::string name;
    std::unique_ptr<AnyConfig> config;  ///< null: it has no keys
  };

  template <typename Made, typename Context>
  explicit PartConfigs(const PartList<Made, Context>& list) {
    for (const auto& part : list.parts())
      entries_.push_back({part.name, part.defaults ? part.defaults->clone() : nullptr});
  }
  PartConfigs(const PartConfigs& other) { *this = other; }
  PartConfigs(PartConfigs&&) = default;
  PartConfigs& operator=(const PartConfigs& other);
  PartConfigs& operator=(PartConfigs&&) = default;

  std::vector<Entry>& entries() { return entries_; }
  Words names() const;
  /// Null where it has no keys.
  AnyConfig* find(std::string_view name) const;
  /// That of a part known to be there with this type.
  template <typename Config>
  Config& of(std::string_view name) const {
    return static_cast<TypedConfig<Config>*>(find(name))->config;
  }

 private:
  std::vector<Entry> entries_;
};

}  // namespace understory
