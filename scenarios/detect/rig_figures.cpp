#include "scenarios/detect/rig_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace understory {
namespace {

/// Between an image's outer edges, half a pixel beyond the centers of the first and last one.
double field_of_view_rad(int size_px, double center_px, double focal_px) {
  return std::atan((center_px + 0.5) / focal_px) + std::atan((size_px - 0.5 - center_px) / focal_px);
}

std::string images_text(const CalibratedRig& calibrated) {
  if (!calibrated.calibration) return "come rectified";
  const auto& [left, right] = std::tie(calibrated.calibration->left, calibrated.calibration->right);
  return fmt::format("raw: rectified here, {}{} distortion coefficients left, {} right",
                     left.lens == LensModel::equidistant ? "fisheye (equidistant), " : "",
                     left.distortion.size(), right.distortion.size());
}

}  // namespace

double degrees(double angle_rad) { return angle_rad * 180 / std::numbers::pi; }

std::string column_text(int disparity_px) {
  return fmt::format("u {} {}", disparity_px < 0 ? '+' : '-', std::abs(disparity_px));
}

RigFigures rig_figures(const StereoRig& rig, const PushbroomConfig& config) {
  const PushbroomStereo detector(rig, config);
  RigFigures figures;
  figures.left_field_of_view_rad = field_of_view_rad(rig.width_px, rig.center_left_x_px, rig.focal_px);
  figures.right_field_of_view_rad = field_of_view_rad(rig.width_px, rig.center_right_x_px, rig.focal_px);
  figures.vertical_field_of_view_rad = field_of_view_rad(rig.height_px, rig.center_y_px, rig.focal_px);
  figures.detection_disparity_px = detector.detection_disparity_px();
  figures.detection_depth_m = detector.detection_depth_m();
  figures.one_pixel = detector.one_pixel_interval();
  figures.window_first_px = detector.infinity_disparity_px() - config.invariance_columns_px;
  figures.window_last_px = detector.infinity_disparity_px() + config.invariance_columns_px;
  const int first_px = std::max(0, figures.detection_disparity_px);
  const int end_px = rig.width_px + std::min(0, figures.detection_disparity_px);
  figures.compared_columns_px = end_px - first_px;
  const double meters_per_px = figures.detection_depth_m / rig.focal_px;
  figures.surface_left_m = (first_px - 0.5 - rig.center_left_x_px) * meters_per_px;
  figures.surface_right_m = (end_px - 0.5 - rig.center_left_x_px) * meters_per_px;
  return figures;
}

std::string to_report(const CalibratedRig& calibrated, const RigFigures& figures) {
  const StereoRig& rig = calibrated.rig;
  const Eigen::Vector3d position_body_m = rig.T_body_camera.translation();
  const Eigen::Vector3d axis_body = rig.T_body_camera.linear().col(2);
  std::string report = rig.name + "\n";
  const auto line = [&](const char* label, const std::string& value) {
    report += fmt::format("  {:<20}{}\n", label, value);
  };
  line("images", fmt::format("{} x {} px, {}", rig.width_px, rig.height_px, images_text(calibrated)));
  line("focal length", fmt::format("{:.2f} px", rig.focal_px));
  line("baseline", fmt::format("{:.4f} m", rig.baseline_m));
  line("principal points", fmt::format("left {:.2f}, right {:.2f}; row {:.2f} px", rig.center_left_x_px,
                                       rig.center_right_x_px, rig.center_y_px));
  line("field of view",
       fmt::format("left {:.1f}, right {:.1f}; vertical {:.1f} deg", degrees(figures.left_field_of_view_rad),
                   degrees(figures.right_field_of_view_rad), degrees(figures.vertical_field_of_view_rad)));
  line("left camera", fmt::format("at ({:.3f}, {:.3f}, {:.3f}) m of the body, looks along "
                                  "({:.3f}, {:.3f}, {:.3f})",
                                  position_body_m.x(), position_body_m.y(), position_body_m.z(),
                                  axis_body.x(), axis_body.y(), axis_body.z()));
  const Eigen::Matrix3d& R_body_camera = rig.T_body_camera.linear();
  if (const double roll_deg = degrees(std::atan2(-R_body_camera(2, 0), -R_body_camera(2, 1)));
      std::abs(roll_deg) >= 0.005)
    line("", fmt::format("rolled {:.2f} deg to the {}", std::abs(roll_deg), roll_deg > 0 ? "right" : "left"));
  line("infinity", fmt::format("{:.2f} px of disparity", rig.infinity_disparity_px()));
  line("asked to look at",
       fmt::format("{:.4g} m: {:.2f} px", rig.detection_depth_m, rig.disparity_px(rig.detection_depth_m)));
  line("detects at",
       fmt::format("{:.2f} m: {} px; one pixel either way {:.2f} to {:.2f} m", figures.detection_depth_m,
                   figures.detection_disparity_px, figures.one_pixel.near_m, figures.one_pixel.far_m));
  line("surface seen", fmt::format("{:.2f} m wide: {} of {} columns have a partner",
                                   figures.surface_right_m - figures.surface_left_m,
                                   figures.compared_columns_px, rig.width_px));
  line("invariance window",
       fmt::format("columns {} to {} of the right image for column u of the left",
                   column_text(figures.window_last_px), column_text(figures.window_first_px)));
  return report;
}

std::vector<LinePlot> rig_plots(const StereoRig& rig, const RigFigures& figures) {
  const DepthInterval band = figures.one_pixel;
  const double far_m = std::min(1.3 * band.far_m, 4 * figures.detection_depth_m);
  LinePlot above{rig.name + " from above", "right of the left camera, m", "ahead, m"};
  above.equal_scale = true;
  const auto add_view = [&](const char* name, double x_m, double center_px, double angle_rad) {
    const double left = (-0.5 - center_px) / rig.focal_px,
                 right = (rig.width_px - 0.5 - center_px) / rig.focal_px;
    above.series.push_back({fmt::format("{} camera, {:.1f} deg", name, degrees(angle_rad)),
                            {x_m + left * far_m, x_m, x_m + right * far_m},
                            {far_m, 0, far_m}});
  };
  add_view("left", 0, rig.center_left_x_px, figures.left_field_of_view_rad);
  add_view("right", rig.baseline_m, rig.center_right_x_px, figures.right_field_of_view_rad);
  const double depth_m = figures.detection_depth_m;
  above.series.push_back({fmt::format("detects at {:.2f} m ({} px)", depth_m, figures.detection_disparity_px),
                          {figures.surface_left_m, figures.surface_right_m},
                          {depth_m, depth_m}});
  const auto edge = [&](double surface_m, double at_m) {
    return surface_m * std::min(at_m, far_m) / depth_m;
  };
  const double left_m = figures.surface_left_m, right_m = figures.surface_right_m;
  const double near_m = band.near_m, end_m = std::min(band.far_m, far_m);
  above.series.push_back({fmt::format("one pixel either way: {:.2f} to {:.2f} m", band.near_m, band.far_m),
                          {edge(left_m, near_m), edge(right_m, near_m), edge(right_m, end_m),
                           edge(left_m, end_m), edge(left_m, near_m)},
                          {near_m, near_m, end_m, end_m, near_m},
                          Mark::dashes});

  LinePlot columns{"Columns compared", "column u of the left image, px", "column of the right image, px"};
  columns.x_range = columns.y_range = AxisRange{0, 1.0 * rig.width_px};
  const auto add_columns = [&](const std::string& name, int disparity_px, Mark mark) {
    const double first = std::max(0, disparity_px), end = rig.width_px + std::min(0, disparity_px);
    columns.series.push_back({name, {first, end}, {first - disparity_px, end - disparity_px}, mark});
  };
  add_columns("a block and its partner: " + column_text(figures.detection_disparity_px),
              figures.detection_disparity_px, Mark::line);
  add_columns("near infinity, from " + column_text(figures.window_last_px), figures.window_last_px,
              Mark::dashes);
  add_columns("to " + column_text(figures.window_first_px) + ": a match here is refused",
              figures.window_first_px, Mark::dashes);
  return {above, columns};
}

}  // namespace understory
