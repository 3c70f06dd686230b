#include <Eigen/Geometry>
#include <array>
#include <opencv2/core/eigen.hpp>

#include "perception/io/calibration/calibration_forms.hpp"
#include "perception/io/strict_map.hpp"
#include "perception/io/text_file.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using namespace rig_limits;

struct Sensor {
  CameraCalibration camera;
  ImageSize size;
  Eigen::Isometry3d T_body_sensor;
  bool says_rectification = false;  ///< the camera's rectification and, but for the baseline, projection
  std::optional<double> detection_depth_m;
};

Eigen::Isometry3d pose(StrictMap& map, double meters_per_unit) {
  constexpr double maximum_value = 1e6;  // an offset in some unit; checked in metres below
  StrictMap fields = map.map("T_BS");
  fields.whole("rows", 4, 4);
  fields.whole("cols", 4, 4);
  const std::vector<double> data = fields.numbers("data", 16, -maximum_value, maximum_value);
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(data.data());
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  if (!is_rotation(cv::Matx44d(data.data()).get_minor<3, 3>(0, 0)))
    map.fail("T_BS", "the first three rows and columns must be a rotation");
  if (!(matrix.row(3) == Eigen::RowVector4d(0, 0, 0, 1))) map.fail("T_BS", "the last row must be 0, 0, 0, 1");
  Eigen::Isometry3d T_body_sensor = Eigen::Isometry3d::Identity();
  T_body_sensor.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  T_body_sensor.translation() = meters_per_unit * matrix.topRightCorner<3, 1>();
  if (T_body_sensor.translation().cwiseAbs().maxCoeff() > maximum_offset_m)
    map.fail("T_BS", "the translation must be at most 10 m");
  return T_body_sensor;
}

/// What `understory record` adds to the layout: how the pair was rectified, which its detector's hits hang
/// on.
void read_additions(StrictMap& map, Sensor& sensor) {
  if (map.has("detection_depth_m"))
    sensor.detection_depth_m = map.number("detection_depth_m", minimum_depth_m, maximum_depth_m);
  sensor.says_rectification = map.has("rectification");
  if (!sensor.says_rectification) return;
  const std::vector<double> rotation = map.numbers("rectification", 9, -1.1, 1.1);
  sensor.camera.rectification = cv::Matx33d(rotation.data());
  if (!is_rotation(sensor.camera.rectification)) map.fail("rectification", "must be a rotation, row by row");
  const std::vector<double> pinhole =
      map.numbers("rectified_intrinsics", 3, minimum_center_px, maximum_focal_px);
  sensor.camera.projection =
      cv::Matx34d(pinhole[0], 0, pinhole[1], 0, 0, pinhole[0], pinhole[2], 0, 0, 0, 1, 0);
}

Sensor read_sensor(const fs::path& file, double meters_per_unit) {
  StrictMap map(parse_yaml(read_file(file), file.string()));
  Sensor sensor;
  sensor.T_body_sensor = pose(map, meters_per_unit);
  sensor.size = resolution(map, "resolution");
  require_text(map, "camera_model", "pinhole");
  sensor.camera.camera_matrix = pinhole_matrix(map, "intrinsics");
  constexpr std::array<LensWord, 2> words{
      {{"radial-tangential", LensModel::radial_tangential}, {"equidistant", LensModel::equidistant}}};
  sensor.camera.lens = lens_model(map, "distortion_model", words);
  // EuRoC has four; cameras that need more of OpenCV's k1 k2 p1 p2 k3 k4 k5 k6 say them in that order.
  const std::size_t found = map.length("distortion_coefficients");
  const bool has_more = sensor.camera.lens == LensModel::radial_tangential && (found == 5 || found == 8);
  sensor.camera.distortion =
      map.numbers("distortion_coefficients", has_more ? found : 4, -maximum_coefficient, maximum_coefficient);
  read_additions(map, sensor);
  map.refuse_others(" sensor_type comment rate_hz ");
  return sensor;
}

}  // namespace

EurocCalibration read_euroc_calibration(const fs::path& folder, const CalibrationOptions& options) {
  const fs::path right_file = folder / "cam1" / "sensor.yaml";
  const Sensor left = read_sensor(folder / "cam0" / "sensor.yaml", options.meters_per_unit.value_or(1));
  const Sensor right = read_sensor(right_file, options.meters_per_unit.value_or(1));
  if (left.size != right.size) refuse_input(right_file.string(), "resolution", "must be that of cam0");
  if (left.camera.lens != right.camera.lens)
    refuse_input(right_file.string(), "distortion_model", "must be that of cam0");
  const ImageSize size = agreed_image_size(folder.string(), left.size, options);

  StereoCalibration calibration;
  calibration.width_px = size.width_px;
  calibration.height_px = size.height_px;
  calibration.left = left.camera;
  calibration.right = right.camera;
  calibration.T_body_left = left.T_body_sensor;
  if (left.says_rectification != right.says_rectification)
    refuse_input(right_file.string(), "rectification", "must be in the files of both cameras or in neither");
  const Eigen::Isometry3d T_right_left = right.T_body_sensor.inverse() * left.T_body_sensor;
  if (T_right_left.translation().x() >= 0)
    refuse_input(right_file.string(), "T_BS", "cam1 must lie to the right of cam0, here it lies to the left");
  if (left.says_rectification) {
    calibration.right.projection(0, 3) =
        -calibration.right.projection(0, 0) * T_right_left.translation().norm();
    return {calibration, left.detection_depth_m};
  }
  cv::Matx33d R_right_left;
  cv::Vec3d t_right_m;
  cv::eigen2cv(Eigen::Matrix3d(T_right_left.linear()), R_right_left);
  cv::eigen2cv(Eigen::Vector3d(T_right_left.translation()), t_right_m);
  if (!rectify_pair(calibration, R_right_left, t_right_m))
    refuse_input(right_file.string(), "T_BS", "cv::stereoRectify cannot bring the two cameras side by side");
  return {calibration, left.detection_depth_m};
}

}  // namespace understory
