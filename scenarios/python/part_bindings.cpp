#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>
#include <variant>

#include "planning/manoeuvre.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/parts/oracles.hpp"
#include "scenarios/python/bindings.hpp"
#include "scenarios/scenario/plugin.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace understory {
namespace {

/// Keys of a part written in Python: name, default value, bounds of numbers, meaning.
struct PythonKey {
  std::string name;
  std::variant<bool, int, double, std::string> value;
  double minimum = 0, maximum = 0;
  std::string meaning;
};

class PythonConfig : public AnyConfig {
 public:
  explicit PythonConfig(std::vector<PythonKey> keys) : keys_(std::move(keys)) {}
  std::unique_ptr<AnyConfig> clone() const override { return std::make_unique<PythonConfig>(keys_); }
  void visit(FieldVisitor& visit) override {
    for (PythonKey& key : keys_) {
      if (auto* flag = std::get_if<bool>(&key.value)) visit(key.name, *flag, key.meaning);
      if (auto* word = std::get_if<std::string>(&key.value)) visit(key.name, *word, key.meaning);
      if (auto* whole = std::get_if<int>(&key.value))
        visit(key.name, *whole, key.minimum, key.maximum, key.meaning);
      if (auto* number = std::get_if<double>(&key.value))
        visit(key.name, *number, key.minimum, key.maximum, key.meaning);
    }
  }
  py::dict values() const {
    py::dict values;
    for (const PythonKey& key : keys_) values[py::str(key.name)] = py::cast(key.value);
    return values;
  }

 private:
  std::vector<PythonKey> keys_;
};

py::dict values_of(const AnyConfig* config) {
  const auto* keys = dynamic_cast<const PythonConfig*>(config);
  return keys == nullptr ? py::dict() : keys->values();
}

/// What a part in Python is made from. It can be asked only while the part is made; the rig and the numbers
/// are copies.
struct PartContext {
  const FlightContext* context = nullptr;
  StereoRig rig;
  py::dict config;
  std::uint64_t seed = 0;
  std::weak_ptr<const char> life;

  const FlightContext& there() const {
    if (context == nullptr)
      throw std::runtime_error("the context can only make parts while this part is made");
    return *context;
  }
};

/// One of our parts, or of another plug-in, for a part in Python to wrap, and no longer than that lives.
template <typename Made>
struct Native {
  std::unique_ptr<Made> made;
  std::weak_ptr<const char> life;

  Made& operator*() const {
    if (life.expired()) throw std::runtime_error("the part that this one was made for has ended");
    return *made;
  }
};

template <typename List>
const auto& part_named(const List& list, const std::string& name) {
  const auto* part = list.find(name);
  if (part == nullptr)
    throw std::invalid_argument(
        fmt::format("there is no part '{}': {}", name, fmt::join(list.names(), ", ")));
  return *part;
}

/// What a planner in Python needs to judge ways.
struct PlanningContext {
  const PlannerPartContext* context = nullptr;
  PlannerConfig config;
  FlightModel model;
  Mission mission;
  py::dict keys;
  std::uint64_t seed = 0;
  std::weak_ptr<const char> life;

  /// Flies commands (bank in rad, climb in m/s, duration in s) from the request's start in the flight model;
  /// the guidance to the course takes over after the last.
  Plan fly(const PlanRequest& request, const std::vector<std::array<double, 3>>& commands) const {
    const ObstacleField field(config.field, request.points, request.distance_flown_m);
    const FlightTask task{model, config.trajectory, mission, field, request.start.position_world};
    Manoeuvre manoeuvre;
    bool straight = true;
    for (const auto& [bank_rad, climb_mps, duration_s] : commands) {
      manoeuvre.push_back({{bank_rad, climb_mps}, duration_s});
      straight = straight && bank_rad == 0 && climb_mps == 0;
    }
    Rollout rollout =
        fly_out(task, request.start, manoeuvre, config.trajectory.minimum_clearance_m, true, false);
    Plan plan;
    plan.t_ns = request.t_ns;
    plan.origin = straight ? PlanOrigin::straight : PlanOrigin::solved;
    plan.points = std::move(rollout.points);
    plan.clearance_m = rollout.minimum_margin_m;
    return plan;
  }
};

/// Where decorators add parts: the table, or the copy that a plug-in is loaded into.
Parts*& open_parts() {
  static Parts* open = nullptr;
  return open;
}
Parts& parts_to_fill() { return open_parts() != nullptr ? *open_parts() : parts(); }

template <typename Made, typename Context>
Part<Made, Context> part_of(const std::string& name, const std::string& meaning, const std::string& file,
                            const std::vector<PythonKey>& keys) {
  Part<Made, Context> part;
  part.name = name;
  part.meaning = meaning;
  part.plugin = file;
  if (!keys.empty()) part.defaults = std::make_shared<const PythonConfig>(keys);
  return part;
}

/// Calls a part's factory with a context that ends with the call. The factory is never let go: the table of
/// parts outlives the interpreter.
template <typename Context, typename Prepare>
py::object made_by(py::handle factory, Context prepared, Prepare&& forget) {
  const py::object context = py::cast(std::move(prepared));
  struct Forgetting {
    const py::object& context;
    Prepare& forget;
    ~Forgetting() { forget(*context.cast<Context*>()); }
  } forgetting{context, forget};
  return factory(context);
}

py::object from_flight(py::handle factory, const FlightContext& context, const Life& life) {
  return made_by(factory,
                 PartContext{&context, context.rig.rig, values_of(context.config), context.seed, life},
                 [](PartContext& kept) { kept.context = nullptr; });
}

void add_detector(const std::string& name, const std::string& meaning, const std::string& file,
                  const std::vector<PythonKey>& keys, const py::object& factory, bool needs_images,
                  double cost_s) {
  if (!(cost_s >= 0 && cost_s <= 10))
    throw py::value_error(fmt::format("cost_s: must be from 0 to 10, got {}", cost_s));
  auto part = part_of<std::unique_ptr<ObstacleDetector>, FlightContext>(name, meaning, file, keys);
  part.make = [kept = factory.inc_ref()](const FlightContext& context) {
    const auto life = std::make_shared<const char>();
    return in_python([&] { return detector_from(from_flight(kept, context, life), life); });
  };
  part.needs_images = needs_images;
  part.cost_s = [cost_s](const PerceptionSection&) { return cost_s; };
  parts_to_fill().detectors.add(std::move(part));
}

void add_state_source(const std::string& name, const std::string& meaning, const std::string& file,
                      const std::vector<PythonKey>& keys, const py::object& factory) {
  auto part = part_of<std::unique_ptr<StateSource>, FlightContext>(name, meaning, file, keys);
  part.make = [kept = factory.inc_ref()](const FlightContext& context) {
    const auto life = std::make_shared<const char>();
    return in_python([&] { return state_source_from(from_flight(kept, context, life), life); });
  };
  parts_to_fill().state_sources.add(std::move(part));
}

void add_planner(const std::string& name, const std::string& meaning, const std::string& file,
                 const std::vector<PythonKey>& keys, const py::object& factory) {
  auto part = part_of<std::unique_ptr<Planner>, PlannerPartContext>(name, meaning, file, keys);
  part.make = [kept = factory.inc_ref()](const PlannerPartContext& context) {
    const auto life = std::make_shared<const char>();
    return in_python([&] {
      return planner_from(
          made_by(kept,
                  PlanningContext{&context, context.PlannerContext::config, context.model, context.mission,
                                  values_of(context.PlannerPartContext::config), context.seed, life},
                  [](PlanningContext& used) { used.context = nullptr; }),
          life);
    });
  };
  parts_to_fill().planners.add(std::move(part));
}

void add_course(const std::string& name, const std::string& meaning, const std::string& file,
                const std::vector<PythonKey>& keys, const py::object& factory) {
  auto part = part_of<Planted, CourseContext>(name, meaning, file, keys);
  part.make = [kept = factory.inc_ref()](const CourseContext& context) {
    return in_python([&] {
      const py::dict config = values_of(context.config);
      Planted planted;
      for (const py::handle one : kept(context.seed, context.scenario.goal_x_m(), **config))
        planted.obstacles.push_back(taken<Obstacle>(one, "the list's entry", "an understory.Obstacle"));
      return planted;
    });
  };
  parts_to_fill().courses.add(std::move(part));
}

/// Runs a plug-in's file through the package, which knows how modules are loaded.
std::vector<std::string> load_python_file(const std::string& file, const std::string& text, Parts& into) {
  open_parts() = &into;
  struct Closing {
    ~Closing() { open_parts() = nullptr; }
  } closing;
  const py::gil_scoped_acquire lock;
  try {
    return py::cast<std::vector<std::string>>(
        py::module_::import("understory").attr("_run_plugin")(file, py::bytes(text)));
  } catch (py::error_already_set& error) {
    throw ScenarioError(told(error));
  }
}

void bind_contexts(py::module_& module) {
  py::class_<Native<ObstacleDetector>>(module, "Detector")
      .def("detect", [](Native<ObstacleDetector>& self, const StereoFrame& frame) {
        return array_of((*self).detect(frame));
      });
  py::class_<Native<StateSource>>(module, "StateSource")
      .def("on", [](Native<StateSource>& self, const Sample& sample) { (*self).on(sample); })
      .def("state", [](const Native<StateSource>& self) { return (*self).state(); })
      .def("state_at",
           [](const Native<StateSource>& self, std::int64_t t_ns) { return (*self).state_at(t_ns); });
  py::class_<Native<Planner>>(module, "Planner")
      .def("plan", [](Native<Planner>& self, const PlanRequest& request) { return (*self).plan(request); })
      .def("concerns",
           [](const Native<Planner>& self, const Eigen::Vector3d& position_world, const Plan& plan) {
             ObstaclePoint point;
             point.position_world = position_world;
             return (*self).concerns(point, plan);
           });
  py::class_<PartContext>(
      module, "PartContext",
      "What a detector or a state source is made from; it makes others only during that call.")
      .def_readonly("rig", &PartContext::rig)
      .def_readonly("config", &PartContext::config)
      .def_readonly("seed", &PartContext::seed)
      .def_property_readonly("obstacles", [](const PartContext& self) { return self.there().obstacles; })
      .def("make_detector",
           [](const PartContext& self, const std::string& name) {
             return Native<ObstacleDetector>{part_named(parts().detectors, name).make(self.there()),
                                             self.life};
           })
      .def("make_state_source", [](const PartContext& self, const std::string& name) {
        return Native<StateSource>{part_named(parts().state_sources, name).make(self.there()), self.life};
      });
  py::class_<PlanningContext>(module, "PlanningContext",
                              "What a planner is made from; it judges manoeuvres as long as it lives.")
      .def_readonly("config", &PlanningContext::keys)
      .def_readonly("seed", &PlanningContext::seed)
      .def_property_readonly(
          "minimum_clearance_m",
          [](const PlanningContext& self) { return self.config.trajectory.minimum_clearance_m; })
      .def_property_readonly(
          "comfortable_clearance_m",
          [](const PlanningContext& self) { return self.config.trajectory.comfortable_clearance_m; })
      .def("fly", &PlanningContext::fly, py::arg("request"), py::arg("commands"))
      .def("make_planner", [](const PlanningContext& self, const std::string& name) {
        if (self.context == nullptr)
          throw std::runtime_error("the context can only make parts while this part is made");
        return Native<Planner>{part_named(parts().planners, name).make(*self.context), self.life};
      });
}

}  // namespace

void bind_parts(py::module_& module) {
  bind_contexts(module);
  py::class_<PythonKey>(
      module, "Key",
      "A key of a part of your own: bool, whole number, number or word, by the type of its value.")
      .def(py::init([](const std::string& name, bool value, const std::string& meaning) {
             return PythonKey{name, value, 0, 0, meaning};
           }),
           py::arg("name"), py::arg("value").noconvert(), py::arg("meaning"))
      .def(py::init(
               [](const std::string& name, int value, int minimum, int maximum, const std::string& meaning) {
                 return PythonKey{name, value, static_cast<double>(minimum), static_cast<double>(maximum),
                                  meaning};
               }),
           py::arg("name"), py::arg("value").noconvert(), py::arg("minimum"), py::arg("maximum"),
           py::arg("meaning"))
      .def(py::init([](const std::string& name, double value, double minimum, double maximum,
                       const std::string& meaning) {
             return PythonKey{name, value, minimum, maximum, meaning};
           }),
           py::arg("name"), py::arg("value"), py::arg("minimum"), py::arg("maximum"), py::arg("meaning"))
      .def(py::init([](const std::string& name, const std::string& value, const std::string& meaning) {
             return PythonKey{name, value, 0, 0, meaning};
           }),
           py::arg("name"), py::arg("value"), py::arg("meaning"));
  module.def("add_detector", add_detector);
  module.def("add_state_source", add_state_source);
  module.def("add_planner", add_planner);
  module.def("add_course", add_course);
  module.def("load_plugin", [](const std::string& name) {
    const std::string& file = load_plugin(name, "load_plugin").file;
    std::vector<std::string>& given =
        given_plugins();  // so that scenarios name it, and what they save flies again
    if (std::ranges::find(given, file) == given.end()) given.push_back(file);
    return file;
  });
  module.def("parts", [] {
    py::dict all;
    all["detector"] = parts().detectors.names();
    all["state_source"] = parts().state_sources.names();
    all["planner"] = parts().planners.names();
    all["course"] = parts().courses.names();
    return all;
  });
  python_loader() = load_python_file;
}

}  // namespace understory
