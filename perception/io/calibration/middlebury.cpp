#include <cmath>

#include "perception/io/calibration/calibration_forms.hpp"
#include "perception/io/calibration/write_calibration.hpp"
#include "perception/io/strict_map.hpp"

namespace understory {
namespace {

using namespace rig_limits;

constexpr double metres_per_millimetre = 1e-3;

/// "[f 0 cx; 0 f cy; 0 0 1]".
cv::Matx33d camera(StrictMap& lines, const std::string& key) {
  const cv::Matx33d K(lines.numbers(key, 9, minimum_center_px, maximum_focal_px).data());
  require_camera_matrix(lines, key, K);
  if (K(0, 0) != K(1, 1)) lines.fail(key, "must have the same focal length twice");
  return K;
}

}  // namespace

StereoCalibration read_middlebury_calibration(const std::filesystem::path& path,
                                              const CalibrationOptions& options) {
  const std::string file = path.string();
  require_metres(file, "Middlebury's calibration, whose baseline is in mm,", options);
  StrictMap lines(parse_keyed_lines(calibration_text(path), file, '='));
  const cv::Matx33d left = camera(lines, "cam0"), right = camera(lines, "cam1");
  if (left(0, 0) != right(0, 0) || left(1, 2) != right(1, 2))
    lines.fail("cam1", "must have the focal length and the row of cam0: the pair is rectified");
  if (std::abs(right(0, 2) - left(0, 2) - lines.number("doffs", -1e4, 1e4)) > 0.01)
    lines.fail("doffs", "must be the column of cam1's principal point less cam0's");
  std::optional<ImageSize> said;
  if (lines.has("width") || lines.has("height") || !options.width_px)
    said = {lines.whole("width", minimum_size_px, maximum_size_px),
            lines.whole("height", minimum_size_px, maximum_size_px)};
  StereoRig rig;
  rig.baseline_m = metres_per_millimetre * lines.number("baseline", 1, 1e5);
  lines.refuse_others(" ndisp isint vmin vmax dyavg dymax ");
  const ImageSize size = agreed_image_size(file, said, options);
  rig.width_px = size.width_px;
  rig.height_px = size.height_px;
  rig.focal_px = left(0, 0);
  rig.center_left_x_px = left(0, 2);
  rig.center_right_x_px = right(0, 2);
  rig.center_y_px = left(1, 2);
  rig.T_body_camera = T_body_camera_of(Eigen::Vector3d::Zero(), 0);
  return cameras_of({rig, std::nullopt});
}

}  // namespace understory
