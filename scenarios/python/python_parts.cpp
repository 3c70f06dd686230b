#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <map>
#include <stdexcept>
#include <utility>

#include "scenarios/output/errors.hpp"
#include "scenarios/parts/checked_parts.hpp"
#include "scenarios/parts/oracles.hpp"
#include "scenarios/python/bindings.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace understory {
namespace {

thread_local bool interrupted = false;

/// An object of Python that a part owns: it is let go with the interpreter's lock held.
class Held {
 public:
  Held(py::object object, Life life) : object_(std::move(object)), life_(std::move(life)) {}
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  ~Held() {
    if (!Py_IsInitialized()) {
      object_.release();
      return;
    }
    or_wait_for_the_end([&] {
      const py::gil_scoped_acquire lock;
      object_ = py::object();
    });
  }
  const py::object& operator*() const { return object_; }
  bool has(const char* method) const { return py::hasattr(object_, method); }

 private:
  py::object object_;
  Life life_;
};

std::vector<StereoHit> hits_of(const py::object& given) {
  const auto expected = [] {
    return std::runtime_error("must give an array of understory.hit_dtype (understory.hits() makes one)");
  };
  register_records();
  if (!py::isinstance<py::array_t<HitRecord>>(given)) throw expected();
  const auto records = py::array_t<HitRecord, py::array::c_style>::ensure(given);
  if (!records || records.ndim() != 1) throw expected();
  std::vector<StereoHit> hits(static_cast<std::size_t>(records.shape(0)));
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const HitRecord& record = records.data()[i];
    hits[i].position_camera = Eigen::Vector3d(record.position_camera);
    hits[i].column_px = record.column_px;
    hits[i].row_px = record.row_px;
    hits[i].disparity_px = record.disparity_px;
    hits[i].score = record.score;
    hits[i].edge_sum = record.edge_sum;
    hits[i].depth = {record.near_m, record.far_m};
  }
  return hits;
}

class PythonDetector : public ObstacleDetector {
 public:
  PythonDetector(py::object object, Life life) : object_(std::move(object), std::move(life)) {}
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override {
    hits_ = in_python([&] { return hits_of((*object_).attr("detect")(frame)); });
    return hits_;
  }

 private:
  Held object_;
  std::vector<StereoHit> hits_;
};

class PythonStateSource : public StateSource {
 public:
  PythonStateSource(py::object object, Life life) : object_(std::move(object), std::move(life)) {
    newest_ = in_python([&] { return asked(); });
  }
  void on(const Sample& sample) override {
    newest_ = in_python([&] {
      (*object_).attr("on")(sample);
      return asked();
    });
  }
  const State& state() const override { return newest_; }
  State state_at(std::int64_t t_ns) const override {
    return in_python([&] { return taken<State>((*object_).attr("state_at")(t_ns), "state_at()", a_state); });
  }

 private:
  static constexpr const char* a_state = "an understory.State";
  State asked() const { return taken<State>((*object_).attr("state")(), "state()", a_state); }
  Held object_;
  State newest_;
};

class PythonPlanner : public Planner {
 public:
  PythonPlanner(py::object object, Life life)
      : object_(std::move(object), std::move(life)),
        has_concerns_(object_.has("concerns")),
        has_counts_(object_.has("counts")) {}
  Plan plan(const PlanRequest& request) override {
    Plan plan = in_python([&] {
      return taken<Plan>((*object_).attr("plan")(request), "plan()",
                         "an understory.Plan (context.fly() makes one)");
    });
    counts_.replans += 1;
    counts_.straight += plan.origin == PlanOrigin::straight;
    counts_.solved += plan.origin == PlanOrigin::solved;
    counts_.kept += plan.origin == PlanOrigin::kept;
    counts_.fallback += plan.origin == PlanOrigin::fallback;
    if (has_counts_) {
      const auto own = in_python([&] {
        return taken<std::map<std::string, std::int64_t>>((*object_).attr("counts"), "counts",
                                                          "a dict of names and whole numbers");
      });
      counts_.own.assign(own.begin(), own.end());
    }
    return plan;
  }
  bool concerns(const ObstaclePoint& point, const Plan& plan) const override {
    if (!has_concerns_) return true;
    return in_python([&] {
      return taken<bool>((*object_).attr("concerns")(Eigen::Vector3d(point.position_world), plan),
                         "concerns()", "True or False");
    });
  }

 private:
  Held object_;
  bool has_concerns_, has_counts_;
};

template <typename Made, typename Adapter>
std::unique_ptr<Made> adapted(const py::object& object, Life life, const char* kind, const char* method) {
  if (!py::hasattr(object, method))
    throw std::runtime_error(fmt::format("a {} must have a method {}()", kind, method));
  return std::make_unique<Adapter>(object, std::move(life));
}

/// A part that makes itself from an object; the context of its making is not looked at.
template <typename One, typename Make>
One part_around(const py::object& object, Make make) {
  One part;
  part.name = py::str(py::type::of(object).attr("__name__"));
  part.plugin = "Python";
  part.make = std::move(make);
  return part;
}

const Scenario& empty_scenario() {
  static const Scenario scenario;
  return scenario;
}

}  // namespace

std::string told(py::error_already_set& error) {
  interrupted = error.matches(PyExc_KeyboardInterrupt);
  std::string text = py::str(error.type().attr("__name__"));
  if (const std::string said = py::str(error.value()); !said.empty()) text += ": " + said;
  py::object trace = error.trace();
  std::string place;
  while (trace && !trace.is_none()) {
    const std::string file = py::str(trace.attr("tb_frame").attr("f_code").attr("co_filename"));
    const bool is_ours = file.starts_with("<frozen") || file.ends_with("/understory/parts.py");
    if (!is_ours)
      place =
          fmt::format(" ({}:{})", file.substr(file.rfind('/') + 1), py::cast<int>(trace.attr("tb_lineno")));
    trace = trace.attr("tb_next");
  }
  return text + place;
}

void throw_as_ours(py::error_already_set& error) {
  const std::string line = told(error);
  PyErr_Display(error.type().ptr(), error.value().ptr(),
                error.trace().ptr());  // PyErr_Print obeys sys.exit()
  throw std::runtime_error(line);
}

std::unique_ptr<ObstacleDetector> detector_from(const py::object& object, Life life) {
  return adapted<ObstacleDetector, PythonDetector>(object, std::move(life), "detector", "detect");
}

std::unique_ptr<StateSource> state_source_from(const py::object& object, Life life) {
  return adapted<StateSource, PythonStateSource>(object, std::move(life), "state source", "state");
}

std::unique_ptr<Planner> planner_from(const py::object& object, Life life) {
  return adapted<Planner, PythonPlanner>(object, std::move(life), "planner", "plan");
}

std::unique_ptr<ObstacleDetector> checked_detector_from(const py::object& object, const CalibratedRig& rig) {
  const auto part =
      part_around<DetectorPart>(object, [&](const FlightContext&) { return detector_from(object); });
  return checked(part, {empty_scenario(), rig, {}, TruthHistory()});
}

std::unique_ptr<StateSource> checked_state_source_from(const py::object& object) {
  const auto part =
      part_around<StateSourcePart>(object, [&](const FlightContext&) { return state_source_from(object); });
  return checked(part, {empty_scenario(), CalibratedRig(), {}, TruthHistory()});
}

std::unique_ptr<Planner> checked_planner_from(const py::object& object) {
  const auto part =
      part_around<PlannerPart>(object, [&](const PlannerPartContext&) { return planner_from(object); });
  const AutopilotConfig& config = empty_scenario().autopilot;
  const FlightModel model(Airframe(), config.flight_model);
  return checked(part, {{config.planner, model, Mission()}, empty_scenario()});
}

bool was_interrupted() { return std::exchange(interrupted, false); }

}  // namespace understory
