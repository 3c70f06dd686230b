#include <array>
#include <cmath>

#include "perception/io/calibration/calibration_forms.hpp"
#include "perception/io/text_file.hpp"

namespace understory {
namespace {

using namespace rig_limits;

RawCamera read_camera(const StrictMap& from) {
  constexpr std::array<LensWord, 2> words{
      {{"radtan", LensModel::radial_tangential}, {"equidistant", LensModel::equidistant}}};
  RawCamera camera{from, {}, {}};
  StrictMap& map = camera.map;
  require_text(map, "camera_model", "pinhole");
  camera.calibration.camera_matrix = pinhole_matrix(map, "intrinsics");
  camera.calibration.lens = lens_model(map, "distortion_model", words);
  camera.calibration.distortion =
      map.numbers("distortion_coeffs", 4, -maximum_coefficient, maximum_coefficient);
  camera.size = resolution(map, "resolution");
  return camera;
}

}  // namespace

StereoCalibration read_kalibr_calibration(const std::filesystem::path& file,
                                          const CalibrationOptions& options) {
  require_metres(file.string(), "Kalibr's camchain", options);
  StrictMap top(parse_yaml(calibration_text(file), file.string()));
  RawCamera left = read_camera(top.map("cam0")), right = read_camera(top.map("cam1"));
  const std::string key = "T_cn_cnm1";
  const cv::Matx44d T_right_left(right.map.numbers(key, 16, -1e6, 1e6).data());
  const cv::Matx33d R_right_left = T_right_left.get_minor<3, 3>(0, 0);
  require_rotation(right.map, key, R_right_left);
  if (T_right_left.row(3) != cv::Matx14d(0, 0, 0, 1))
    right.map.fail(key, "must have 0, 0, 0, 1 in the last row");
  for (const StrictMap* camera : {&left.map, &right.map})
    camera->refuse_others(" rostopic cam_overlaps T_cam_imu timeshift_cam_imu ");
  top.refuse_others();
  StereoCalibration calibration = raw_pair(left, right, file.string(), "resolution", options);
  const cv::Vec3d t_right_m(T_right_left(0, 3), T_right_left(1, 3), T_right_left(2, 3));
  rectify_pair(calibration, R_right_left, t_right_m, right.map, key);
  return calibration;
}

}  // namespace understory
