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

struct Sensor : RawCamera {
  Eigen::Isometry3d T_body_sensor = Eigen::Isometry3d::Identity();
  bool says_rectification = false;  ///< the camera's rectification and, but for the baseline, projection
  std::optional<double> detection_depth_m = {};
};

Eigen::Isometry3d pose(StrictMap& map, double meters_per_unit) {
  constexpr double maximum_value = 1e6;  // an offset in some unit; checked in metres below
  StrictMap fields = map.map("T_BS");
  fields.whole("rows", 4, 4);
  fields.whole("cols", 4, 4);
  const std::vector<double> data = fields.numbers("data", 16, -maximum_value, maximum_value);
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(data.data());
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  require_rotation(map, "T_BS", cv::Matx44d(data.data()).get_minor<3, 3>(0, 0));
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
  sensor.calibration.rectification = cv::Matx33d(rotation.data());
  require_rotation(map, "rectification", sensor.calibration.rectification);
  const std::vector<double> pinhole =
      map.numbers("rectified_intrinsics", 3, minimum_center_px, maximum_focal_px);
  sensor.calibration.projection =
      cv::Matx34d(pinhole[0], 0, pinhole[1], 0, 0, pinhole[0], pinhole[2], 0, 0, 0, 1, 0);
}

Sensor read_sensor(const fs::path& file, double meters_per_unit) {
  Sensor sensor{{StrictMap(parse_yaml(read_file(file), file.string())), {}, {}}};
  StrictMap& map = sensor.map;
  sensor.T_body_sensor = pose(map, meters_per_unit);
  sensor.size = resolution(map, "resolution");
  require_text(map, "camera_model", "pinhole");
  sensor.calibration.camera_matrix = pinhole_matrix(map, "intrinsics");
  constexpr std::array<LensWord, 2> words{
      {{"radial-tangential", LensModel::radial_tangential}, {"equidistant", LensModel::equidistant}}};
  sensor.calibration.lens = lens_model(map, "distortion_model", words);
  // EuRoC has four; cameras that need more of OpenCV's k1 k2 p1 p2 k3 k4 k5 k6 say them in that order.
  const std::size_t found = map.length("distortion_coefficients");
  const bool has_more = sensor.calibration.lens == LensModel::radial_tangential && (found == 5 || found == 8);
  sensor.calibration.distortion =
      map.numbers("distortion_coefficients", has_more ? found : 4, -maximum_coefficient, maximum_coefficient);
  read_additions(map, sensor);
  map.refuse_others(" sensor_type comment rate_hz ");
  return sensor;
}

}  // namespace

EurocCalibration read_euroc_calibration(const fs::path& folder, const CalibrationOptions& options) {
  const Sensor left = read_sensor(folder / "cam0" / "sensor.yaml", options.meters_per_unit.value_or(1));
  const Sensor right = read_sensor(folder / "cam1" / "sensor.yaml", options.meters_per_unit.value_or(1));
  StereoCalibration calibration = raw_pair(left, right, folder.string(), "resolution", options);
  calibration.T_body_left = left.T_body_sensor;
  if (left.says_rectification != right.says_rectification)
    right.map.fail("rectification", "must be in the files of both cameras or in neither");
  const Eigen::Isometry3d T_right_left = right.T_body_sensor.inverse() * left.T_body_sensor;
  if (left.says_rectification) {
    if (T_right_left.translation().x() >= 0)
      right.map.fail("T_BS", "cam1 must lie to the right of cam0, here it lies to the left");
    calibration.right.projection(0, 3) =
        -calibration.right.projection(0, 0) * T_right_left.translation().norm();
    return {calibration, left.detection_depth_m};
  }
  cv::Matx33d R_right_left;
  cv::Vec3d t_right_m;
  cv::eigen2cv(Eigen::Matrix3d(T_right_left.linear()), R_right_left);
  cv::eigen2cv(Eigen::Vector3d(T_right_left.translation()), t_right_m);
  rectify_pair(calibration, R_right_left, t_right_m, right.map, "T_BS");
  return {calibration, left.detection_depth_m};
}

}  // namespace understory
