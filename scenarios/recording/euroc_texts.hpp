#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>

#include "estimation/samples.hpp"
#include "perception/io/calibration/calibration_file.hpp"
#include "planning/airframe.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/scene/trees.hpp"
#include "sim/sensors/sensors.hpp"

namespace understory {

// The texts of a EuRoC/ASL folder, as its readers expect them. Frames: EuRoC's body is ours (x forward, y
// left, z up, at the centre of mass), a camera has OpenCV's axes.

/// A recording's clock at simulated t_ns, nanoseconds. Starts at 10^18, in 2001: never zero, and with 19
/// digits like EuRoC's own, so that names of images sort as times.
constexpr std::int64_t recorded_ns(std::int64_t t_ns) { return 1'000'000'000'000'000'000 + t_ns; }

/// A camera as in its sensor.yaml.
struct RecordedCamera {
  CameraCalibration camera;  ///< rectified images: no distortion, rectification the identity
  Eigen::Isometry3d T_body_camera = Eigen::Isometry3d::Identity();
};

/// Both cameras of rig_of's rig, left first: raw where it has a calibration, else the rectified pair.
std::array<RecordedCamera, 2> recorded_cameras(const CalibratedRig& rig);

/// A camera's sensor.yaml. Beyond EuRoC's keys: how the pair is rectified and at which depth the detector
/// looks, as read_euroc_calibration takes them.
std::string camera_sensor_text(const RecordedCamera& camera, const StereoRig& rig, int rate_hz);
enum class Side { left, right };
/// The sensor.yaml of the depth images, which are always those of a rectified camera.
std::string depth_sensor_text(const StereoRig& rig, int rate_hz, Side side);
/// The sensor.yaml of the images of objects, which are of the same camera.
std::string objects_sensor_text(const StereoRig& rig, int rate_hz);
/// imu0/sensor.yaml: noise per root hertz; the random walks are 0 where the scenario has them off.
std::string imu_sensor_text(const ImuConfig& config, int rate_hz);
/// The sensor.yaml of the body's states, true or estimated.
std::string state_sensor_text(const std::string& comment);

/// First lines and lines of the data.csv files. Nanoseconds, SI; quaternion w x y z, body into world.
inline constexpr const char* image_header = "#timestamp [ns],filename\n";
inline constexpr const char* imu_header =
    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
    "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n";
inline constexpr const char* state_header =
    "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z [],"
    "v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1],"
    "b_w_RS_S_x [rad s^-1],b_w_RS_S_y [rad s^-1],b_w_RS_S_z [rad s^-1],"
    "b_a_RS_S_x [m s^-2],b_a_RS_S_y [m s^-2],b_a_RS_S_z [m s^-2]\n";

inline constexpr const char* objects_header =
    "#number,name,kind,from_x [m],from_y [m],from_z [m],to_x [m],to_y [m],to_z [m],radius [m]\n";

std::string imu_line(const ImuSample& sample);

/// Lines of the data.csv files of pitot0, barometer0, magnetometer0, gps0, controls0 and body0, and their
/// first lines by folder. body0 is the truth beyond the pose: angular rate, acceleration minus gravity, wind,
/// surfaces.
std::string sample_line(const PitotSample& sample);
std::string sample_line(const BarometerSample& sample);
std::string sample_line(const MagnetometerSample& sample);
std::string sample_line(const GpsSample& sample);
std::string controls_line(std::int64_t t_ns, const Controls& controls);
std::string body_line(const Truth& truth);
std::string sample_header(const std::string& folder);

/// objects0/objects.csv: what the numbers in the images of objects stand for, the ground first. World frame.
/// A tree's trunk is one object and its branches another, with a line for each piece; its leaves, the plants,
/// the logs and the far wood (kinds foliage, undergrowth, log, far_wood) have no geometry.
std::string objects_text(const Wood& wood);

/// A line of a state's data.csv; t_ns is simulated time.
struct RecordedState {
  std::int64_t t_ns = 0;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_mps2 = Eigen::Vector3d::Zero();
};
std::string state_line(const RecordedState& state);

}  // namespace understory
