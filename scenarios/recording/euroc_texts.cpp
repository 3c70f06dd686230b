#include "scenarios/recording/euroc_texts.hpp"

#include <fmt/core.h>

#include <cmath>
#include <opencv2/core/eigen.hpp>

#include "perception/io/calibration/write_calibration.hpp"
#include "scenarios/output/program.hpp"

namespace understory {
namespace {

std::string pose_text(const Eigen::Isometry3d& T_body_sensor) {
  const Eigen::Matrix4d& m = T_body_sensor.matrix();
  std::string text = "T_BS:\n  cols: 4\n  rows: 4\n  data: [";
  for (int row = 0; row < 4; ++row)
    text += fmt::format("{}{}, {}, {}, {}", row > 0 ? ",\n         " : "", m(row, 0), m(row, 1), m(row, 2),
                        m(row, 3));
  return text + "]\n";
}

std::string head_text(const char* type, const std::string& comment, const Eigen::Isometry3d& T_body_sensor) {
  return fmt::format("sensor_type: {}\ncomment: understory {}, {}\n\n{}", type, understory_version, comment,
                     pose_text(T_body_sensor));
}

/// What cameras and depth images share.
std::string pinhole_text(const CameraCalibration& camera, const StereoRig& rig, int rate_hz) {
  const cv::Matx33d& K = camera.camera_matrix;
  return fmt::format(
      "\nrate_hz: {}\nresolution: [{}, {}]\ncamera_model: pinhole\n"
      "intrinsics: [{}, {}, {}, {}] # fu, fv, cu, cv\n"
      "distortion_model: {}\ndistortion_coefficients: [{}]\n",
      rate_hz, rig.width_px, rig.height_px, K(0, 0), K(1, 1), K(0, 2), K(1, 2),
      camera.lens == LensModel::equidistant ? "equidistant" : "radial-tangential",
      list_text(camera.distortion));
}

std::string vector_text(const Eigen::Vector3d& v, int digits) {
  return fmt::format(",{:.{}f},{:.{}f},{:.{}f}", v.x(), digits, v.y(), digits, v.z(), digits);
}

Eigen::Isometry3d T_body_right_of(const StereoRig& rig) {
  return rig.T_body_camera * Eigen::Translation3d(rig.baseline_m, 0, 0);
}

}  // namespace

std::array<RecordedCamera, 2> recorded_cameras(const CalibratedRig& calibrated) {
  const StereoCalibration cameras = cameras_of(calibrated);
  Eigen::Isometry3d T_body_right = T_body_right_of(calibrated.rig);
  Eigen::Matrix3d R_rectified_raw;
  cv::cv2eigen(cameras.right.rectification, R_rectified_raw);
  T_body_right.linear() = T_body_right.linear() * R_rectified_raw;
  std::array<RecordedCamera, 2> recorded{RecordedCamera{cameras.left, cameras.T_body_left},
                                         RecordedCamera{cameras.right, T_body_right}};
  for (RecordedCamera& one : recorded)
    if (one.camera.distortion.empty()) one.camera.distortion = {0, 0, 0, 0};
  return recorded;
}

std::string camera_sensor_text(const RecordedCamera& recorded, const StereoRig& rig, int rate_hz) {
  const CameraCalibration& camera = recorded.camera;
  const cv::Matx34d& P = camera.projection;
  return head_text("camera", "simulated", recorded.T_body_camera) + pinhole_text(camera, rig, rate_hz) +
         fmt::format(
             "\n# Not EuRoC's: camera axes into rectified ones; the rectified pair's focal length, cu, cv; "
             "where the detector looks.\nrectification: [{}]\nrectified_intrinsics: [{}, {}, {}]\n"
             "detection_depth_m: {}\n",
             list_text(camera.rectification.val), P(0, 0), P(0, 2), P(1, 2), rig.detection_depth_m);
}

std::string depth_sensor_text(const StereoRig& rig, int rate_hz, Side side) {
  const bool left = side == Side::left;
  const Eigen::Isometry3d T_body_eye = left ? rig.T_body_camera : T_body_right_of(rig);
  return head_text("depth",
                   fmt::format("true depth along the optical axis of the rectified {} camera",
                               left ? "left" : "right"),
                   T_body_eye) +
         pinhole_text(rectified_camera(rig, left ? rig.center_left_x_px : rig.center_right_x_px, 0), rig,
                      rate_hz) +
         "depth_unit_m: 0.001 # 16-bit PNG; 0: nothing within 65.535 m\n";
}

std::string objects_sensor_text(const StereoRig& rig, int rate_hz) {
  return head_text("objects", "which object the rectified left camera sees", rig.T_body_camera) +
         pinhole_text(rectified_camera(rig, rig.center_left_x_px, 0), rig, rate_hz) +
         "objects: objects.csv # 16-bit PNG; 0: nothing\n";
}

std::string imu_sensor_text(const ImuConfig& config, int rate_hz) {
  // White noise of a density d, sampled at a rate f behind a filter that wide, has the deviation d sqrt(f).
  const double per_root_hz = 1 / std::sqrt(static_cast<double>(rate_hz));
  return head_text("imu", "simulated", Eigen::Isometry3d::Identity()) +
         fmt::format(
             "rate_hz: {}\n\n"
             "gyroscope_noise_density: {:.6g}     # [ rad / s / sqrt(Hz) ]\n"
             "gyroscope_random_walk: {:.6g}       # [ rad / s^2 / sqrt(Hz) ]\n"
             "accelerometer_noise_density: {:.6g} # [ m / s^2 / sqrt(Hz) ]\n"
             "accelerometer_random_walk: {:.6g}   # [ m / s^3 / sqrt(Hz) ]\n",
             rate_hz, config.gyro_noise_radps * per_root_hz, config.gyro_walk_radpsps_rthz,
             config.accelerometer_noise_mps2 * per_root_hz, config.accelerometer_walk_mps2ps_rthz);
}

std::string state_sensor_text(const std::string& comment) {
  return head_text("visual-inertial", comment, Eigen::Isometry3d::Identity());
}

std::string imu_line(const ImuSample& sample) {
  return fmt::format("{}", recorded_ns(sample.t_ns)) + vector_text(sample.angular_rate_body_radps, 9) +
         vector_text(sample.specific_force_body_mps2, 9) + "\n";
}

std::string sample_line(const PitotSample& sample) {
  return fmt::format("{},{:.9f}\n", recorded_ns(sample.t_ns), sample.airspeed_mps);
}

std::string sample_line(const BarometerSample& sample) {
  return fmt::format("{},{:.9f}\n", recorded_ns(sample.t_ns), sample.altitude_m);
}

std::string sample_line(const MagnetometerSample& sample) {
  return fmt::format("{}", recorded_ns(sample.t_ns)) + vector_text(sample.field_body_ut, 9) + "\n";
}

std::string sample_line(const GpsSample& sample) {
  return fmt::format("{}", recorded_ns(sample.t_ns)) + vector_text(sample.position_world_m, 9) +
         vector_text(sample.velocity_world_mps, 9) + "\n";
}

std::string controls_line(std::int64_t t_ns, const Controls& controls) {
  return fmt::format("{},{:.9f},{:.9f},{:.9f}\n", recorded_ns(t_ns), controls.left_elevon_rad,
                     controls.right_elevon_rad, controls.thrust_n);
}

std::string body_line(const Truth& truth) {
  return fmt::format("{}", recorded_ns(truth.t_ns)) + vector_text(truth.angular_rate_body_radps, 9) +
         vector_text(truth.specific_force_body_mps2, 9) + vector_text(truth.wind_world_mps, 9) +
         fmt::format(",{:.9f},{:.9f},{:.9f}\n", truth.left_elevon_rad, truth.right_elevon_rad,
                     truth.thrust_n);
}

std::string sample_header(const std::string& folder) {
  const std::string time = "#timestamp [ns],";
  const std::string surfaces = "left_elevon [rad],right_elevon [rad],thrust [N]\n";
  if (folder == "pitot0") return time + "airspeed [m s^-1]\n";
  if (folder == "barometer0") return time + "altitude [m]\n";
  if (folder == "magnetometer0") return time + "field_x [uT],field_y [uT],field_z [uT]\n";
  if (folder == "gps0") return time + "p_x [m],p_y [m],p_z [m],v_x [m s^-1],v_y [m s^-1],v_z [m s^-1]\n";
  if (folder == "controls0") return time + surfaces;
  return time +
         "w_x [rad s^-1],w_y [rad s^-1],w_z [rad s^-1],a_x [m s^-2],a_y [m s^-2],a_z [m s^-2],"
         "wind_x [m s^-1],wind_y [m s^-1],wind_z [m s^-1]," +
         surfaces;
}

std::string objects_text(const Wood& wood) {
  std::string text = objects_header;
  const auto add = [&](std::size_t number, std::string_view name, std::string_view kind,
                       const Obstacle& obstacle, double radius_m) {
    text += fmt::format("{},{},{}{}{},{:.6f}\n", number, name, kind, vector_text(obstacle.from_world, 6),
                        vector_text(obstacle.to_world, 6), radius_m);
  };
  add(object_ground, "ground", "ground", Obstacle{}, 0);
  const WoodsNumbers numbers{wood.trees.size()};
  std::size_t alone = 0;
  for (const Obstacle& obstacle : wood.obstacles) {
    const auto tree = static_cast<std::size_t>(obstacle.tree);
    const bool branch = obstacle.kind == ObstacleKind::branch;
    const std::size_t number = obstacle.tree >= 0 ? (branch ? numbers.branch(tree) : numbers.trunk(tree))
                               : wood.scenery == Scenery::plain ? object_first_obstacle + alone++
                                                                : numbers.alone(alone++);
    const std::string name = branch ? fmt::format("tree_{:04}_branches", tree) : obstacle.name;
    add(number, name, word_for(obstacle.kind), obstacle, obstacle.radius_m);
  }
  if (wood.scenery == Scenery::plain) return text;
  for (std::size_t i = 0; i < wood.trees.size(); ++i)
    add(numbers.leaves(i), fmt::format("tree_{:04}_leaves", i), "foliage", Obstacle{}, 0);
  add(numbers.undergrowth(), "undergrowth", "undergrowth", Obstacle{}, 0);
  add(numbers.log(), "logs", "log", Obstacle{}, 0);
  add(numbers.far_wood(), "far_wood", "far_wood", Obstacle{}, 0);
  return text;
}

std::string state_line(const RecordedState& state) {
  const Eigen::Quaterniond q(state.T_world_body.linear());
  return fmt::format("{}", recorded_ns(state.t_ns)) + vector_text(state.T_world_body.translation(), 9) +
         fmt::format(",{:.12f},{:.12f},{:.12f},{:.12f}", q.w(), q.x(), q.y(), q.z()) +
         vector_text(state.velocity_world_mps, 9) + vector_text(state.gyro_bias_radps, 9) +
         vector_text(state.accelerometer_bias_mps2, 9) + "\n";
}

}  // namespace understory
