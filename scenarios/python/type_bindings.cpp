#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <stdexcept>

#include "estimation/samples.hpp"
#include "planning/flight_model.hpp"
#include "planning/plan.hpp"
#include "scenarios/course/courses.hpp"
#include "scenarios/python/bindings.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/scene/obstacle.hpp"

namespace understory {
namespace {

/// A pose as the 4x4 matrix that takes body coordinates into world coordinates.
template <typename Owner>
void add_pose(py::class_<Owner>& type) {
  type.def_property(
      "T_world_body", [](const Owner& owner) -> Eigen::Matrix4d { return owner.T_world_body.matrix(); },
      [](Owner& owner, const Eigen::Matrix4d& matrix) { owner.T_world_body.matrix() = matrix; });
  type.def_property_readonly("position_world_m", [](const Owner& owner) -> Eigen::Vector3d {
    return owner.T_world_body.translation();
  });
}

cv::Mat image_of(const py::array& array, const char* name) {
  if (array.ndim() != 2 || !py::isinstance<py::array_t<std::uint8_t>>(array))
    throw std::invalid_argument(std::string(name) +
                                " must be an array of shape (rows, columns) and type uint8");
  const auto bytes = py::array_t<std::uint8_t, py::array::c_style>::ensure(array);
  const cv::Mat view(static_cast<int>(bytes.shape(0)), static_cast<int>(bytes.shape(1)), CV_8UC1,
                     const_cast<std::uint8_t*>(bytes.data()));
  return view.clone();
}

void bind_samples(py::module_& module) {
  py::class_<ImuSample>(module, "ImuSample", "Angular rate and acceleration minus gravity, body axes.")
      .def_readonly("t_ns", &ImuSample::t_ns)
      .def_readonly("angular_rate_body_radps", &ImuSample::angular_rate_body_radps)
      .def_readonly("specific_force_body_mps2", &ImuSample::specific_force_body_mps2);
  py::class_<PitotSample>(module, "PitotSample")
      .def_readonly("t_ns", &PitotSample::t_ns)
      .def_readonly("airspeed_mps", &PitotSample::airspeed_mps);
  py::class_<BarometerSample>(module, "BarometerSample")
      .def_readonly("t_ns", &BarometerSample::t_ns)
      .def_readonly("altitude_m", &BarometerSample::altitude_m);
  py::class_<MagnetometerSample>(module, "MagnetometerSample")
      .def_readonly("t_ns", &MagnetometerSample::t_ns)
      .def_readonly("field_body_ut", &MagnetometerSample::field_body_ut);
  py::class_<GpsSample>(module, "GpsSample", "A fix, which arrives late: t_ns is the moment of measurement.")
      .def_readonly("t_ns", &GpsSample::t_ns)
      .def_readonly("position_world_m", &GpsSample::position_world_m)
      .def_readonly("velocity_world_mps", &GpsSample::velocity_world_mps);
  py::class_<ThrustSample>(module, "ThrustSample", "The thrust commanded from t_ns on.")
      .def_readonly("t_ns", &ThrustSample::t_ns)
      .def_readonly("thrust_n", &ThrustSample::thrust_n);
  py::class_<ResightingSample>(module, "ResightingSample",
                               "An obstacle seen again nearer: how far its place has moved in between.")
      .def_readonly("t_ns", &ResightingSample::t_ns)
      .def_readonly("earlier_ns", &ResightingSample::earlier_ns)
      .def_readonly("discrepancy_world_m", &ResightingSample::discrepancy_world_m)
      .def_readonly("covariance_m2", &ResightingSample::covariance_m2);
}

void bind_states(py::module_& module) {
  py::class_<State> state(
      module, "State",
      "The aircraft as an estimator believes it to be. Its world frame drifts slowly against the true one.");
  state.def(py::init<>())
      .def("copy", [](const State& self) { return State(self); })
      .def_readwrite("t_ns", &State::t_ns)
      .def_readwrite("velocity_body_mps", &State::velocity_body_mps)
      .def_readwrite("angular_rate_body_radps", &State::angular_rate_body_radps)
      .def_readwrite("specific_force_body_mps2", &State::specific_force_body_mps2)
      .def_readwrite("gyro_bias_radps", &State::gyro_bias_radps)
      .def_readwrite("wind_world_mps", &State::wind_world_mps)
      .def_readwrite("altitude_m", &State::altitude_m)
      .def_readwrite("distance_flown_m", &State::distance_flown_m)
      .def_property_readonly("covariance",
                             [](const State& self) -> Eigen::MatrixXd { return self.covariance; });
  add_pose(state);
  py::class_<Truth> truth(module, "Truth", "The true state.");
  truth.def_readonly("t_ns", &Truth::t_ns)
      .def_readonly("velocity_world_mps", &Truth::velocity_world_mps)
      .def_readonly("angular_rate_body_radps", &Truth::angular_rate_body_radps)
      .def_readonly("specific_force_body_mps2", &Truth::specific_force_body_mps2)
      .def_readonly("wind_world_mps", &Truth::wind_world_mps)
      .def_readonly("left_elevon_rad", &Truth::left_elevon_rad)
      .def_readonly("right_elevon_rad", &Truth::right_elevon_rad)
      .def_readonly("thrust_n", &Truth::thrust_n);
  add_pose(truth);
  py::class_<Controls>(module, "Controls", "Elevons (trailing edge up positive) and thrust.")
      .def(py::init([](double left_elevon_rad, double right_elevon_rad, double thrust_n) {
             return Controls{left_elevon_rad, right_elevon_rad, thrust_n};
           }),
           py::arg("left_elevon_rad") = 0, py::arg("right_elevon_rad") = 0, py::arg("thrust_n") = 0)
      .def_readonly("left_elevon_rad", &Controls::left_elevon_rad)
      .def_readonly("right_elevon_rad", &Controls::right_elevon_rad)
      .def_readonly("thrust_n", &Controls::thrust_n);
}

void bind_vision(py::module_& module) {
  py::class_<StereoRig>(
      module, "StereoRig",
      "A rectified pair. Pixel (0, 0) is the centre of the top left one; disparity is u_left - u_right.")
      .def_readonly("name", &StereoRig::name)
      .def_readonly("width_px", &StereoRig::width_px)
      .def_readonly("height_px", &StereoRig::height_px)
      .def_readonly("focal_px", &StereoRig::focal_px)
      .def_readonly("baseline_m", &StereoRig::baseline_m)
      .def_readonly("center_left_x_px", &StereoRig::center_left_x_px)
      .def_readonly("center_right_x_px", &StereoRig::center_right_x_px)
      .def_readonly("center_y_px", &StereoRig::center_y_px)
      .def_readonly("detection_depth_m", &StereoRig::detection_depth_m)
      .def_property_readonly("infinity_disparity_px", &StereoRig::infinity_disparity_px)
      .def_property_readonly(
          "T_body_camera", [](const StereoRig& rig) -> Eigen::Matrix4d { return rig.T_body_camera.matrix(); })
      .def("disparity_px", py::vectorize(&StereoRig::disparity_px), py::arg("depth_m"))
      .def("depth_m", py::vectorize(&StereoRig::depth_m), py::arg("disparity_px"));
  py::class_<StereoFrame>(module, "StereoFrame",
                          "A pair: uint8, (rows, columns); arrays cannot be written to.")
      .def(py::init([](const py::array& left, const py::array& right, std::int64_t t_ns) {
             StereoFrame frame{t_ns, image_of(left, "left"), image_of(right, "right")};
             if (frame.left.size() != frame.right.size())
               throw std::invalid_argument("left and right must have one shape");
             return frame;
           }),
           py::arg("left"), py::arg("right"), py::arg("t_ns") = 0)
      .def_readonly("t_ns", &StereoFrame::t_ns)
      .def_property_readonly("left", [](const StereoFrame& frame) { return array_of(frame.left); })
      .def_property_readonly("right", [](const StereoFrame& frame) { return array_of(frame.right); });
}

py::array_t<double> points_of(const Plan& plan) {
  py::array_t<double> points({static_cast<py::ssize_t>(plan.points.size()), py::ssize_t{10}});
  auto row = points.mutable_unchecked<2>();
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const PlanPoint& point = plan.points[i];
    const double values[] = {point.t_s,
                             point.position_world.x(),
                             point.position_world.y(),
                             point.position_world.z(),
                             point.speed_mps,
                             point.heading_rad,
                             point.climb_angle_rad,
                             point.bank_rad,
                             point.bank_command_rad,
                             point.climb_command_mps};
    for (py::ssize_t j = 0; j < 10; ++j) row(static_cast<py::ssize_t>(i), j) = values[j];
  }
  return points;
}

void bind_planning(py::module_& module) {
  py::class_<FlightState>(
      module, "FlightState",
      "Where a plan starts: heights are above the ground, angles are those of the velocity through the air.")
      .def_readonly("position_world_m", &FlightState::position_world)
      .def_readonly("wind_world_mps", &FlightState::wind_world_mps)
      .def_readonly("speed_mps", &FlightState::speed_mps)
      .def_readonly("heading_rad", &FlightState::heading_rad)
      .def_readonly("climb_angle_rad", &FlightState::climb_angle_rad)
      .def_readonly("bank_rad", &FlightState::bank_rad);
  py::class_<Plan>(module, "Plan",
                   "points: rows of t_s, x, y, z (m), speed_mps, heading, climb angle, bank, commanded bank "
                   "(rad), commanded climb (m/s). origin: straight, solved, kept or fallback. clearance_m: "
                   "least free distance, inf if nothing is near.")
      .def_readonly("t_ns", &Plan::t_ns)
      .def_readonly("clearance_m", &Plan::clearance_m)
      .def_property_readonly("origin", [](const Plan& plan) { return std::string(word_for(plan.origin)); })
      .def_property_readonly("points", points_of);
  py::class_<PlanRequest>(module, "PlanRequest")
      .def_readonly("start", &PlanRequest::start)
      .def_readonly("t_ns", &PlanRequest::t_ns)
      .def_readonly("distance_flown_m", &PlanRequest::distance_flown_m)
      .def_readonly("outdated", &PlanRequest::outdated)
      .def_property_readonly("points", [](const PlanRequest& request) { return array_of(request.points); });
  py::class_<Obstacle>(module, "Obstacle")
      .def(py::init([](const std::string& name, const Eigen::Vector3d& from_world,
                       const Eigen::Vector3d& to_world, double radius_m, const std::string& kind) {
             Obstacle obstacle;
             obstacle.name = name;
             obstacle.from_world = from_world;
             obstacle.to_world = to_world;
             obstacle.radius_m = radius_m;
             const auto word = std::ranges::find(obstacle_kind_names, kind);
             if (word == obstacle_kind_names.end() || kind == "wall" || kind == "box" || kind == "branch")
               throw std::invalid_argument(
                   "kind must be trunk, post, crossbar, rail, capsule or sphere (box() makes boxes), got '" +
                   kind + "'");
             obstacle.kind = static_cast<ObstacleKind>(word - obstacle_kind_names.begin());
             return obstacle;
           }),
           py::arg("name"), py::arg("from_world"), py::arg("to_world"), py::arg("radius_m"),
           py::arg("kind") = "trunk")
      .def_readonly("name", &Obstacle::name)
      .def_readonly("from_world", &Obstacle::from_world)
      .def_readonly("to_world", &Obstacle::to_world)
      .def_readonly("radius_m", &Obstacle::radius_m)
      .def_property_readonly("kind", [](const Obstacle& one) { return std::string(word_for(one.kind)); });
  module.def("box", [](const std::string& name, const Eigen::Vector3d& position_m,
                       const Eigen::Vector3d& size_m, const Eigen::Vector3d& rotation_rad) {
    return placed({name, ListedShape::box, position_m, rotation_rad, size_m});
  });
}

}  // namespace

void register_records() {
  static const bool registered = [] {
    PYBIND11_NUMPY_DTYPE(HitRecord, position_camera, column_px, row_px, disparity_px, score, edge_sum, near_m,
                         far_m);
    PYBIND11_NUMPY_DTYPE(PointRecord, position_world, t_ns, score, distance_flown_m, sightings);
    return true;
  }();
  static_cast<void>(registered);
}

py::array_t<HitRecord> array_of(const std::vector<StereoHit>& hits) {
  register_records();
  py::array_t<HitRecord> array(static_cast<py::ssize_t>(hits.size()));
  HitRecord* record = array.mutable_data();
  for (const StereoHit& hit : hits) {
    *record++ = {{hit.position_camera.x(), hit.position_camera.y(), hit.position_camera.z()},
                 hit.column_px,
                 hit.row_px,
                 hit.disparity_px,
                 hit.score,
                 hit.edge_sum,
                 hit.depth.near_m,
                 hit.depth.far_m};
  }
  return array;
}

py::array_t<PointRecord> array_of(const std::vector<ObstaclePoint>& points) {
  register_records();
  py::array_t<PointRecord> array(static_cast<py::ssize_t>(points.size()));
  PointRecord* record = array.mutable_data();
  for (const ObstaclePoint& point : points) {
    const Eigen::Vector3d& p = point.position_world;
    *record++ = {{p.x(), p.y(), p.z()}, point.t_ns, point.score, point.distance_flown_m, point.sightings};
  }
  return array;
}

py::array array_of(const cv::Mat& image) {
  if (image.empty()) return py::array_t<std::uint8_t>(std::vector<py::ssize_t>{0, 0});
  const py::dtype type = image.type() == CV_8UC1    ? py::dtype::of<std::uint8_t>()
                         : image.type() == CV_16UC1 ? py::dtype::of<std::uint16_t>()
                         : image.type() == CV_8UC3  ? py::dtype::of<std::uint8_t>()
                                                    : py::dtype::of<float>();
  std::vector<py::ssize_t> shape{image.rows, image.cols};
  std::vector<py::ssize_t> strides{static_cast<py::ssize_t>(image.step[0]),
                                   static_cast<py::ssize_t>(image.elemSize())};
  if (image.channels() > 1) {
    shape.push_back(image.channels());
    strides.push_back(static_cast<py::ssize_t>(image.elemSize1()));
  }
  auto owner = std::make_unique<cv::Mat>(image);
  const py::capsule keeper(owner.get(), [](void* kept) { delete static_cast<cv::Mat*>(kept); });
  py::array array(type, shape, strides, owner.release()->data, keeper);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

void bind_types(py::module_& module) {
  module.def("hit_dtype", [] {
    register_records();
    return py::dtype::of<HitRecord>();
  });
  module.def("point_dtype", [] {
    register_records();
    return py::dtype::of<PointRecord>();
  });
  bind_samples(module);
  bind_states(module);
  bind_vision(module);
  bind_planning(module);
}

}  // namespace understory
