#include "scenarios/report/overlay.hpp"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace understory {
namespace {

const cv::Scalar blue(255, 64, 0);
const cv::Scalar red(0, 0, 255);
constexpr double mph_per_mps = 2.2369362920544;
constexpr double feet_per_m = 3.2808398950131;
constexpr double nearest_drawn_m = 0.5;

void write_text(cv::Mat& picture, const std::string& text, cv::Point place, double size) {
  constexpr int font = cv::FONT_HERSHEY_SIMPLEX;
  cv::putText(picture, text, place, font, size, cv::Scalar(0, 0, 0), 4, cv::LINE_AA);
  cv::putText(picture, text, place, font, size, cv::Scalar(255, 255, 255), 1, cv::LINE_AA);
}

void write_at_side(cv::Mat& picture, const std::string& text, bool at_right) {
  constexpr double size = 0.7;
  int baseline = 0;
  const cv::Size extent = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 2, &baseline);
  write_text(picture, text, {at_right ? picture.cols - extent.width - 12 : 12, picture.rows / 2}, size);
}

}  // namespace

cv::Mat draw_overlay(const OverlayMoment& moment, const StereoRig& rig, int scale) {
  cv::Mat picture;
  cv::resize(moment.left, picture, cv::Size(), scale, scale, cv::INTER_NEAREST);
  cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  const Eigen::Isometry3d T_camera_world = moment.T_world_camera.inverse();
  for (const ObstaclePoint& point : moment.remembered) {
    const Eigen::Vector3d seen = T_camera_world * point.position_world;
    if (seen.z() < nearest_drawn_m) continue;
    const double u = rig.focal_px * seen.x() / seen.z() + rig.center_left_x_px;
    const double v = rig.focal_px * seen.y() / seen.z() + rig.center_y_px;
    if (u < 0 || v < 0 || u >= rig.width_px || v >= rig.height_px) continue;
    cv::circle(picture, cv::Point(static_cast<int>((u + 0.5) * scale), static_cast<int>((v + 0.5) * scale)),
               scale + 1, red, cv::FILLED, cv::LINE_AA);
  }
  for (const StereoHit& hit : moment.hits) {
    const cv::Rect box(hit.column_px * scale, hit.row_px * scale, 5 * scale, 5 * scale);
    cv::rectangle(picture, box, blue, scale > 1 ? 2 : 1);
  }
  if (moment.airspeed_mps)
    write_at_side(picture, fmt::format("{:.0f} mph", *moment.airspeed_mps * mph_per_mps), false);
  if (moment.altitude_m)
    write_at_side(picture, fmt::format("{:.0f} ft", *moment.altitude_m * feet_per_m), true);
  if (!moment.caption.empty()) write_text(picture, moment.caption, {12, picture.rows - 12}, 0.5);
  return picture;
}

}  // namespace understory
