#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "perception/io/calibration/calibration_forms.hpp"
#include "perception/io/strict_map.hpp"
#include "perception/io/text_file.hpp"

namespace understory {
namespace {

using namespace rig_limits;

/// Of calib.txt, its kinds for odometry and for objects, and of calib_cam_to_cam.txt.
std::string other_keys() {
  std::string keys = " Tr Tr_velo_cam Tr_velo Tr_velo_to_cam Tr_imu_to_velo R0_rect calib_time corner_dist ";
  for (const char* kind : {"P", "P_rect", "S", "S_rect", "K", "D", "R", "R_rect", "T"})
    for (int camera = 0; camera < 4; ++camera) keys += fmt::format("{0}{1} {0}_0{1} ", kind, camera);
  return keys;
}

cv::Matx34d projection(StrictMap& lines, const std::string& key) {
  return cv::Matx34d(lines.numbers(key, 12, -1e9, 1e9).data());
}

}  // namespace

StereoCalibration read_kitti_calibration(const std::filesystem::path& path,
                                         const CalibrationOptions& options) {
  const std::string file = path.string();
  require_metres(file, "KITTI's calibration", options);
  StrictMap lines(parse_keyed_lines(calibration_text(path), file, ':'));
  using Pair = std::array<std::string, 2>;
  const std::array<Pair, 4> pairs{
      {{"P_rect_00", "P_rect_01"}, {"P0", "P1"}, {"P_rect_02", "P_rect_03"}, {"P2", "P3"}}};
  const std::size_t first = options.of_colour_pair ? 2 : 0;
  const auto pair = std::find_if(pairs.begin() + first, pairs.end(),
                                 [&](const Pair& one) { return lines.has(one[0]) && lines.has(one[1]); });
  if (pair == pairs.end()) refuse_input(file, "P0", "missing, with P1: the cameras' projections");
  StereoCalibration calibration;
  calibration.left.projection = projection(lines, (*pair)[0]);
  calibration.right.projection = projection(lines, (*pair)[1]);
  // The colour cameras are counted from the gray left one.
  calibration.right.projection(0, 3) -= calibration.left.projection(0, 3);
  std::optional<ImageSize> size;
  if (const std::string key = "S_rect_" + (*pair)[0].substr((*pair)[0].size() - 2); lines.has(key))
    size = resolution(lines, key);
  lines.refuse_others(other_keys());
  const ImageSize agreed = agreed_image_size(file, size, options);
  for (CameraCalibration* camera : {&calibration.left, &calibration.right})
    camera->camera_matrix = camera->projection.get_minor<3, 3>(0, 0);
  calibration.width_px = agreed.width_px;
  calibration.height_px = agreed.height_px;
  calibration.T_body_left = T_body_camera_of(Eigen::Vector3d::Zero(), 0);
  return calibration;
}

}  // namespace understory
