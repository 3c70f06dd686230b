#pragma once

#include <cxxabi.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "estimation/state_source.hpp"
#include "perception/obstacle_detector.hpp"
#include "planning/planner.hpp"
#include "scenarios/parts/parts.hpp"

/// The Python module `_understory`, which the package `understory` wraps (docs/python.md).
namespace understory {

namespace py = pybind11;

/// A hit, and a point of the map, as records of numpy arrays. Fields as in StereoHit and ObstaclePoint.
struct HitRecord {
  double position_camera[3];
  std::int32_t column_px, row_px;
  double disparity_px, score, edge_sum, near_m, far_m;
};
struct PointRecord {
  double position_world[3];
  std::int64_t t_ns;
  double score, distance_flown_m;
  std::int32_t sightings;
};

/// Registers both with numpy. Numpy is imported when it is needed first: it takes two thirds of the time to
/// import this.
void register_records();

py::array_t<HitRecord> array_of(const std::vector<StereoHit>& hits);
py::array_t<PointRecord> array_of(const std::vector<ObstaclePoint>& points);
/// An image as a read-only array that keeps it alive: no copy is made.
py::array array_of(const cv::Mat& image);

/// Lives as long as a Python object's part. Our parts made for it refer to its flight and check it.
using Life = std::shared_ptr<const char>;

/// Objects of Python as parts. They call Python with its lock held. Throw std::runtime_error, one line, where
/// an object lacks a method, raises, or gives what cannot be understood; a traceback goes to standard error.
std::unique_ptr<ObstacleDetector> detector_from(const py::object& object, Life life = nullptr);
std::unique_ptr<StateSource> state_source_from(const py::object& object, Life life = nullptr);
std::unique_ptr<Planner> planner_from(const py::object& object, Life life = nullptr);
/// The same behind the checks that a plug-in's parts get (checked_parts.hpp), for objects handed to a flight.
std::unique_ptr<ObstacleDetector> checked_detector_from(const py::object& object, const CalibratedRig& rig);
std::unique_ptr<StateSource> checked_state_source_from(const py::object& object);
std::unique_ptr<Planner> checked_planner_from(const py::object& object);

/// An exception of Python as one line: "ValueError: too small (mine.py:12)".
std::string told(py::error_already_set& error);
/// Prints the traceback; throws the line as std::runtime_error.
[[noreturn]] void throw_as_ours(py::error_already_set& error);

/// If a thread requests Python's lock while the interpreter ends, Python ends the thread by unwinding its
/// frames. Our destructors would request it, too, so such a thread waits here until the process has ended.
template <typename Function>
auto or_wait_for_the_end(Function&& function) {
  try {
    return function();
  } catch (const abi::__forced_unwind&) {
    for (;;) pause();
  }
}

/// Calls Python with its lock held; its exceptions become std::runtime_error.
template <typename Function>
auto in_python(Function&& function) {
  return or_wait_for_the_end([&] {
    const py::gil_scoped_acquire lock;
    return or_wait_for_the_end([&] {
      try {
        return function();
      } catch (py::error_already_set& error) {
        throw_as_ours(error);
      }
    });
  });
}

/// Throws TypeError in one line if it is not such a value: "plan(): must be a Plan, got NoneType".
template <typename Value>
Value taken(const py::handle& given, const char* name, const char* what) {
  try {
    return py::cast<Value>(given);
  } catch (const py::builtin_exception&) {  // cast_error, and another at None
    throw py::type_error(std::string(name) + ": must be " + what + ", got " + Py_TYPE(given.ptr())->tp_name);
  }
}

/// Whether the newest exception of Python on this thread came from the keyboard (Ctrl-C); clears this. The
/// flight then ended with an error that the part did not cause.
bool was_interrupted();

// What the module holds, a file each.
void bind_types(py::module_& module);  ///< plain data: samples, states, frames, plans
void bind_parts(py::module_& module);  ///< parts written in Python
void bind_scenario(py::module_& module);
void bind_flight(py::module_& module);

/// Throws if the scenario's text could not be flown again, because no file defines one of its parts.
void require_files(const Scenario& scenario);

}  // namespace understory
