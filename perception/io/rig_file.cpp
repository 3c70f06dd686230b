#include "perception/io/rig_file.hpp"

#include <cmath>
#include <numbers>

#include "perception/io/rig_limits.hpp"
#include "perception/io/strict_map.hpp"
#include "perception/io/text_file.hpp"

namespace understory {

Eigen::Isometry3d T_body_camera_of(const Eigen::Vector3d& left_camera_body_m, double pitch_down_rad) {
  const double c = std::cos(pitch_down_rad), s = std::sin(pitch_down_rad);
  Eigen::Isometry3d T_body_camera = Eigen::Isometry3d::Identity();
  T_body_camera.linear().col(0) = Eigen::Vector3d(0, -1, 0);   // camera x: to the right
  T_body_camera.linear().col(1) = Eigen::Vector3d(-s, 0, -c);  // camera y: down
  T_body_camera.linear().col(2) = Eigen::Vector3d(c, 0, -s);   // camera z: ahead
  T_body_camera.translation() = left_camera_body_m;
  return T_body_camera;
}

StereoRig read_rig(const std::filesystem::path& file) {
  using namespace rig_limits;
  StrictMap map(file.string(), parse_yaml(read_text_file(file), file.string()));
  StereoRig rig;
  rig.name = map.text("name");
  rig.width_px = map.whole("width_px", minimum_size_px, maximum_size_px);
  rig.height_px = map.whole("height_px", minimum_size_px, maximum_size_px);
  rig.focal_px = map.number("focal_px", minimum_focal_px, maximum_focal_px);
  rig.baseline_m = map.number("baseline_m", minimum_baseline_m, maximum_baseline_m);
  rig.center_left_x_px = map.number("center_left_x_px", minimum_center_px, maximum_center_px);
  rig.center_right_x_px = map.number("center_right_x_px", minimum_center_px, maximum_center_px);
  rig.center_y_px = map.number("center_y_px", minimum_center_px, maximum_center_px);
  rig.detection_depth_m = map.number("detection_depth_m", minimum_depth_m, maximum_depth_m);
  const std::vector<double> left_camera_body_m =
      map.numbers("left_camera_body_m", 3, -maximum_offset_m, maximum_offset_m);
  const double pitch_down_deg = map.number("pitch_down_deg", -90, 90);
  map.refuse_others();
  rig.T_body_camera =
      T_body_camera_of(Eigen::Vector3d(left_camera_body_m.data()), pitch_down_deg * std::numbers::pi / 180);
  if (!detection_depth_in_view(rig))
    map.fail("detection_depth_m",
             "expected a depth more than a pixel nearer than infinity and inside the image");
  return rig;
}

}  // namespace understory
