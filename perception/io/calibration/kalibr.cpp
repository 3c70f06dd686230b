#include <array>
#include <cmath>

#include "perception/io/calibration/calibration_forms.hpp"
#include "perception/io/text_file.hpp"

namespace understory {
namespace {

using namespace rig_limits;

struct Camera {
  CameraCalibration calibration;
  ImageSize size;
};

Camera read_camera(StrictMap& map) {
  constexpr std::array<LensWord, 2> words{
      {{"radtan", LensModel::radial_tangential}, {"equidistant", LensModel::equidistant}}};
  Camera camera;
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
  StrictMap first = top.map("cam0"), second = top.map("cam1");
  const Camera left = read_camera(first), right = read_camera(second);
  if (left.size != right.size) second.fail("resolution", "must be that of cam0");
  if (left.calibration.lens != right.calibration.lens)
    second.fail("distortion_model", "must be that of cam0");
  const cv::Matx44d T_right_left(second.numbers("T_cn_cnm1", 16, -1e6, 1e6).data());
  const auto R_right_left = T_right_left.get_minor<3, 3>(0, 0);
  const cv::Vec3d t_right_m(T_right_left(0, 3), T_right_left(1, 3), T_right_left(2, 3));
  if (!is_rotation(R_right_left) || T_right_left.row(3) != cv::Matx14d(0, 0, 0, 1))
    second.fail("T_cn_cnm1", "must be a rotation and a translation, and 0, 0, 0, 1 in the last row");
  if (t_right_m[0] >= 0)
    second.fail("T_cn_cnm1", "cam1 must lie to the right of cam0, here it lies to the left");
  for (StrictMap* camera : {&first, &second})
    camera->refuse_others(" rostopic cam_overlaps T_cam_imu timeshift_cam_imu ");
  top.refuse_others();

  const ImageSize size = agreed_image_size(file.string(), left.size, options);
  StereoCalibration calibration{"",
                                size.width_px,
                                size.height_px,
                                left.calibration,
                                right.calibration,
                                T_body_camera_of(Eigen::Vector3d::Zero(), 0)};
  if (!rectify_pair(calibration, R_right_left, t_right_m))
    second.fail("T_cn_cnm1", "OpenCV cannot bring the two cameras side by side");
  return calibration;
}

}  // namespace understory
