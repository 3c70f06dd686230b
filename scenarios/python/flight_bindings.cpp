#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "perception/io/text_table.hpp"
#include "planning/path_follower.hpp"
#include "scenarios/config/keys.hpp"
#include "scenarios/flight/actions.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/flight_logger.hpp"
#include "scenarios/flight/flight_page.hpp"
#include "scenarios/flight/run_files.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/output_folder.hpp"
#include "scenarios/python/bindings.hpp"
#include "scenarios/scenario/data_files.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// Flies what it is told, and remembers it.
class ToldPilot : public Pilot {
 public:
  explicit ToldPilot(const Scenario& scenario)
      : model_(scenario.airframe, scenario.autopilot.flight_model), follower_(scenario.autopilot.follower) {}

  Controls controls(std::int64_t t_ns, const State& state) override {
    Controls now = command ? follow(model_, follower_, *command, state) : direct;
    const Airframe& airframe = model_.airframe();
    now.left_elevon_rad = std::clamp(now.left_elevon_rad, airframe.elevon_min_rad, airframe.elevon_max_rad);
    now.right_elevon_rad = std::clamp(now.right_elevon_rad, airframe.elevon_min_rad, airframe.elevon_max_rad);
    now.thrust_n = std::clamp(now.thrust_n, 0.0, airframe.max_thrust_n);
    if (flown.empty() || !is_same(flown.back().controls, now)) flown.push_back({t_ns, now});
    return now;
  }

  Controls direct;                       ///< where there is no command
  std::optional<FlightCommand> command;  ///< for the path follower
  std::vector<Action> flown;

 private:
  static bool is_same(const Controls& one, const Controls& other) {
    return one.left_elevon_rad == other.left_elevon_rad && one.right_elevon_rad == other.right_elevon_rad &&
           one.thrust_n == other.thrust_n;
  }
  FlightModel model_;
  PathFollowerConfig follower_;
};

/// Counts what happens in a step, and keeps the newest IMU samples.
class StepWatcher : public FlightObserver {
 public:
  explicit StepWatcher(bool images) : images_(images) {}
  bool needs_images() const override { return images_; }
  bool wants_frame() const override { return images_ && draws; }
  const char* stage() const override { return "python"; }
  void on_frame(const Flight&) override { ++frames; }
  void on_step(const Flight& flight) override {
    if (!flight.clock().imu()) return;
    const std::optional<ImuSample>& sample = flight.newest<ImuSample>();
    if (!sample) return;
    imu[newest = (newest + 1) % imu.size()] = *sample;
  }

  bool draws = true;  ///< images that it asked for
  std::int64_t frames = 0;
  std::array<ImuSample, 16> imu{};
  std::size_t newest = 15;

 private:
  bool images_;
};

enum class Until { physics, control, camera, end };

Until until_of(std::string_view word) {
  if (word == "physics") return Until::physics;
  if (word == "control") return Until::control;
  if (word == "camera") return Until::camera;
  if (word == "end") return Until::end;
  throw py::value_error(fmt::format("step: must be physics, control, camera or end, got '{}'", word));
}

std::atomic<int> at_work = 0;           ///< threads that fly without Python's lock
std::atomic<bool> python_ends = false;  ///< threads but the one that ends it stop
thread_local bool ends_python = false;
thread_local int flights_within = 0;  ///< that this thread flies, one within the other

/// Runs what needs no lock of Python's: other threads go on. Once Python has ended, it does not come back.
template <typename Function>
void without_lock(Function&& function) {
  PyThreadState* const state = PyEval_SaveThread();
  if (flights_within++ == 0) ++at_work;
  std::exception_ptr fault;
  try {
    function();
  } catch (const std::exception&) {
    fault = std::current_exception();
  }
  if (--flights_within == 0) --at_work;
  or_wait_for_the_end([&] { PyEval_RestoreThread(state); });
  if (fault) std::rethrow_exception(fault);
}

/// Threads that fly stop between two steps, and stay there while the process ends around them.
void stop_flights() {
  python_ends = ends_python = true;
  const py::gil_scoped_release released;
  constexpr int longest_ms = 2000;
  for (int waited_ms = 0; at_work > 0 && waited_ms < longest_ms; ++waited_ms)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

/// A flight as Python holds it: its own thread alone may use it, and an error ends it.
class HeldFlight {
 public:
  HeldFlight(const Scenario& scenario, const py::object& detector, const py::object& state_source,
             const py::object& planner, bool by_hand, bool images, bool record, const std::string& renderer)
      : watcher_(images), records_(record) {
    const auto kind =
        std::ranges::find(renderer_names, renderer, &decltype(renderer_names)::value_type::first);
    if (kind == renderer_names.end())
      throw py::value_error("renderer: must be osmesa, egl or auto, got '" + renderer + "'");
    const FlightMachine machine{data_root() / "models", kind->second};
    FlightParts given;
    if (!detector.is_none())
      given.detector = checked_detector_from(detector, rig_of(scenario, machine.models_folder));
    if (!state_source.is_none()) given.state_source = checked_state_source_from(state_source);
    if (!planner.is_none()) given.planner = checked_planner_from(planner);
    if (by_hand) {
      auto pilot = std::make_unique<ToldPilot>(scenario);
      pilot_ = pilot.get();
      given.pilot = std::move(pilot);
    }
    std::vector<FlightObserver*> observers;
    if (record) observers.push_back(&logger_);
    observers.push_back(&watcher_);
    without_lock([&] {
      flight_ = std::make_unique<Flight>(scenario, machine, std::move(observers), std::move(given));
    });
  }

  const Flight& flight() const {
    if (std::this_thread::get_id() != thread_)
      throw std::runtime_error(
          "a flight belongs to the thread that made it: OpenGL and MuJoCo are bound to it");
    return *flight_;
  }

  /// Whether it still flies.
  bool advance(Until until) {
    flight();
    if (!fault_.empty()) throw MachineError(fault_);
    if (std::exchange(is_stepped_, true))
      throw std::runtime_error("a part cannot step the flight that it is a part of: this is within a step");
    const std::unique_ptr<bool, void (*)(bool*)> stepping(&is_stepped_, [](bool* flag) { *flag = false; });
    bool goes_on = true;
    without_lock([&] {
      try {
        goes_on = fly_until(until);
      } catch (const std::exception& error) {
        fault_ = error.what();
        throw;
      }
    });
    if (!goes_on) throw py::error_already_set();
    return !flight_->outcome();
  }

  void tell(const py::object& left_elevon_rad, const py::object& right_elevon_rad,
            const py::object& thrust_n) {
    const Controls controls{number(left_elevon_rad, "left_elevon_rad"),
                            number(right_elevon_rad, "right_elevon_rad"), number(thrust_n, "thrust_n")};
    told_pilot().command.reset();
    told_pilot().direct = controls;
  }
  void command(const py::object& bank_rad, const py::object& climb_mps) {
    told_pilot().command = FlightCommand{number(bank_rad, "bank_rad"), number(climb_mps, "climb_mps")};
  }
  std::string flown_actions() { return actions_text(told_pilot().flown); }

  const FlightLog& log() const {
    flight();
    if (!records_) throw std::runtime_error("this flight keeps no record: make it with record=True");
    return logger_.log();
  }
  const FlightLog& finished_log() const {
    const FlightLog& all = log();
    if (!flight_->outcome()) throw std::runtime_error("the flight has not ended");
    return all;
  }

  /// The newest IMU samples, oldest first: one row (angular rate, specific force) each; airspeed and
  /// altitude; the direction of gravity in body axes.
  py::tuple observation(py::ssize_t imu_rows) const {
    const Flight& now = flight();
    if (imu_rows < 1 || imu_rows > static_cast<py::ssize_t>(watcher_.imu.size()))
      throw py::value_error("imu_rows: must be 1 to 16");
    py::array_t<float> imu({imu_rows, py::ssize_t{6}}), air(4), gravity(3);
    float* to = imu.mutable_data();
    for (py::ssize_t row = 0; row < imu_rows; ++row) {
      const std::size_t back = static_cast<std::size_t>(imu_rows - 1 - row);
      const ImuSample& sample =
          watcher_.imu[(watcher_.newest + watcher_.imu.size() - back) % watcher_.imu.size()];
      for (int axis = 0; axis < 3; ++axis) *to++ = static_cast<float>(sample.angular_rate_body_radps[axis]);
      for (int axis = 0; axis < 3; ++axis) *to++ = static_cast<float>(sample.specific_force_body_mps2[axis]);
    }
    const std::optional<PitotSample>& pitot = now.newest<PitotSample>();
    const State& state = now.state();
    air.mutable_data()[0] = static_cast<float>(pitot ? pitot->airspeed_mps : 0);
    air.mutable_data()[1] = static_cast<float>(state.altitude_m);
    const Eigen::Matrix3d& turn = state.T_world_body.linear();
    air.mutable_data()[2] = static_cast<float>(state.T_world_body.translation().y());
    air.mutable_data()[3] = static_cast<float>(std::atan2(turn(1, 0), turn(0, 0)));
    for (int axis = 0; axis < 3; ++axis) gravity.mutable_data()[axis] = static_cast<float>(-turn(2, axis));
    return py::make_tuple(imu, air, gravity);
  }

  cv::Mat chase_view(const py::object& width_px, const py::object& height_px) const {
    const int width = side(width_px, "width_px"), height = side(height_px, "height_px");
    if (flight().cameras() == nullptr)
      throw std::runtime_error("this flight has no images: make it with images=True");
    return flight_->cameras()->chase_view(flight_->truth(), width, height);
  }

  TrueView true_view() const {
    if (flight().cameras() == nullptr)
      throw std::runtime_error("this flight has no images: make it with images=True");
    return flight_->cameras()->true_view(flight_->truth().T_world_body);
  }

  std::int64_t frames() const { return watcher_.frames; }
  void draw_images(bool draws) { watcher_.draws = draws; }

 private:
  static double number(const py::object& given, const char* name) {
    const double value = taken<double>(given, name, "a number");
    if (std::isnan(value)) throw py::value_error(std::string(name) + ": must be a number, got nan");
    return value;
  }
  /// Of a picture.
  static int side(const py::object& given, const char* name) {
    constexpr int most = 8192;
    const auto pixels = taken<std::int64_t>(given, name, "a whole number");
    if (pixels < 1 || pixels > most)
      throw py::value_error(fmt::format("{}: must be from 1 to {}, got {}", name, most, pixels));
    return static_cast<int>(pixels);
  }

  ToldPilot& told_pilot() {
    flight();
    if (pilot_ == nullptr)
      throw std::runtime_error("the planner flies this flight: make it with by_hand=True");
    return *pilot_;
  }

  /// False where the keyboard interrupted, with Python's error set.
  bool fly_until(Until until) {
    constexpr int steps_between_looks = 600;
    const std::int64_t frames_before = watcher_.frames;
    while (!flight_->outcome()) {
      if (python_ends && !ends_python) {
        --at_work;
        for (;;) pause();
      }
      flight_->step();
      if (++steps_ % steps_between_looks == 0 && !in_python([] { return PyErr_CheckSignals() == 0; }))
        return false;
      if (until == Until::physics || (until == Until::control && flight_->clock().imu()) ||
          (until == Until::camera && watcher_.frames > frames_before))
        break;
    }
    return true;
  }

  std::thread::id thread_ = std::this_thread::get_id();
  FlightLogger logger_;
  StepWatcher watcher_;
  bool records_;
  ToldPilot* pilot_ = nullptr;
  std::unique_ptr<Flight> flight_;
  std::string fault_;  ///< what ended it, and not as a flight ends
  std::int64_t steps_ = 0;
  bool is_stepped_ = false;
};

/// Fields of a result as Python's values.
py::dict result_of(const HeldFlight& held) {
  py::dict values, own;
  const FlightResult& result = held.finished_log().result;
  const auto visit = [&]<typename Value>(const char* name, const Value& value, const char*) {
    if constexpr (std::is_same_v<Value, Outcome>)
      values[name] = std::string(word_for(value));
    else
      values[name] = value;
  };
  visit_fields(visit, result);
  for (const auto& [name, number] : result.planner.own) own[py::str(name)] = number;
  values["planner_counts"] = own;
  return values;
}

/// One row for every 5 ms: time, true position, true quaternion (w, x, y, z), true velocity, clearance.
py::array_t<double> trajectory_of(const HeldFlight& held) {
  const std::vector<LogMoment>& moments = held.log().moments;
  py::array_t<double> rows({static_cast<py::ssize_t>(moments.size()), py::ssize_t{12}});
  double* to = rows.mutable_data();
  for (const LogMoment& moment : moments) {
    *to++ = seconds(moment.t_ns);
    for (int axis = 0; axis < 3; ++axis) *to++ = moment.T_world_body.translation()[axis];
    const Eigen::Quaterniond turn(moment.T_world_body.linear());
    for (const double part : {turn.w(), turn.x(), turn.y(), turn.z()}) *to++ = part;
    for (int axis = 0; axis < 3; ++axis) *to++ = moment.velocity_world_mps[axis];
    *to++ = moment.clearance_m;
  }
  return rows;
}

void save_run(const HeldFlight& held, const std::string& folder) {
  const FlightLog& log = held.finished_log();
  require_files(log.scenario);
  OutputFolder output(folder, flight_results, scenario_to_text(log.scenario), Replace::nothing);
  write_run_files(log, output.path());
  output.finish();
}

}  // namespace

void bind_flight(py::module_& module) {
  py::module_::import("atexit").attr("register")(py::cpp_function(stop_flights));
  py::class_<HeldFlight>(module, "Flight")
      .def(py::init<const Scenario&, const py::object&, const py::object&, const py::object&, bool, bool,
                    bool, const std::string&>(),
           py::arg("scenario"), py::arg("detector"), py::arg("state_source"), py::arg("planner"),
           py::arg("by_hand"), py::arg("images"), py::arg("record"), py::arg("renderer"))
      .def("advance",
           [](HeldFlight& self, const py::object& until) {
             return self.advance(until_of(taken<std::string>(until, "step", "a word")));
           })
      .def("advance_control", [](HeldFlight& self) { return self.advance(Until::control); })
      .def("advance_camera", [](HeldFlight& self) { return self.advance(Until::camera); })
      .def("tell", &HeldFlight::tell, py::arg("left_elevon_rad"), py::arg("right_elevon_rad"),
           py::arg("thrust_n"))
      .def("command", &HeldFlight::command, py::arg("bank_rad"), py::arg("climb_mps"))
      .def("flown_actions", &HeldFlight::flown_actions)
      .def("observation", &HeldFlight::observation, py::arg("imu_rows"))
      .def("draw_images", &HeldFlight::draw_images, py::arg("draws"))
      .def_property_readonly("frames", &HeldFlight::frames)
      .def_property_readonly("scenario", [](const HeldFlight& self) { return self.flight().scenario(); })
      .def_property_readonly("rig", [](const HeldFlight& self) { return self.flight().rig().rig; })
      .def_property_readonly("t_ns", [](const HeldFlight& self) { return self.flight().clock().t_ns(); })
      .def_property_readonly("in_flight", [](const HeldFlight& self) { return self.flight().in_flight(); })
      .def_property_readonly(
          "progress_m",
          [](const HeldFlight& self) { return self.flight().truth().T_world_body.translation().x(); })
      .def_property_readonly("outcome",
                             [](const HeldFlight& self) -> py::object {
                               const std::optional<Outcome>& outcome = self.flight().outcome();
                               if (!outcome) return py::none();
                               return py::str(std::string(word_for(*outcome)));
                             })
      .def_property_readonly("truth", [](const HeldFlight& self) { return self.flight().truth(); })
      .def_property_readonly("state", [](const HeldFlight& self) { return self.flight().state(); })
      .def_property_readonly("plan", [](const HeldFlight& self) { return self.flight().plan(); })
      .def_property_readonly("controls", [](const HeldFlight& self) { return self.flight().controls(); })
      .def_property_readonly("obstacles", [](const HeldFlight& self) { return self.flight().obstacles(); })
      .def_property_readonly("hits", [](const HeldFlight& self) { return array_of(self.flight().hits()); })
      .def_property_readonly("map",
                             [](const HeldFlight& self) { return array_of(self.flight().map().points()); })
      .def_property_readonly("frame", [](const HeldFlight& self) { return self.flight().frame(); })
      .def_property_readonly("depth",
                             [](const HeldFlight& self) { return array_of(self.true_view().depth_m); })
      .def_property_readonly("objects",
                             [](const HeldFlight& self) { return array_of(self.true_view().objects); })
      .def("chase_view",
           [](const HeldFlight& self, const py::object& width_px, const py::object& height_px) {
             return array_of(self.chase_view(width_px, height_px));
           })
      .def_property_readonly("imu", [](const HeldFlight& self) { return self.flight().newest<ImuSample>(); })
      .def_property_readonly("pitot",
                             [](const HeldFlight& self) { return self.flight().newest<PitotSample>(); })
      .def_property_readonly("barometer",
                             [](const HeldFlight& self) { return self.flight().newest<BarometerSample>(); })
      .def_property_readonly(
          "magnetometer", [](const HeldFlight& self) { return self.flight().newest<MagnetometerSample>(); })
      .def_property_readonly("gps", [](const HeldFlight& self) { return self.flight().newest<GpsSample>(); })
      .def_property_readonly("result", result_of)
      .def_property_readonly("trajectory", trajectory_of)
      .def("page", [](const HeldFlight& self) { return flight_page(self.finished_log(), {data_root()}); })
      .def("save_run", save_run, py::arg("folder"));
}

}  // namespace understory
