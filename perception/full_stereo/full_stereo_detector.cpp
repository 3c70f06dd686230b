#include "perception/full_stereo/full_stereo_detector.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace understory {
namespace {

constexpr double uncertainty_px = 0.5;
constexpr double unlimited_m = 1000;

}  // namespace

FullStereoCrop one_pixel_crop(const StereoRig& rig) {
  const double disparity_px = std::round(rig.disparity_px(rig.detection_depth_m));
  FullStereoCrop crop;
  crop.minimum_depth_m = rig.depth_m(disparity_px + 1);
  crop.maximum_depth_m = rig.depth_m(disparity_px - 1);
  crop.maximum_below_m = unlimited_m;  // the pushbroom's rows alone
  return crop;
}

const std::vector<StereoHit>& FullStereoDetector::detect(const StereoFrame& frame) {
  depth_m_ = stereo_.depth_m(frame);  // the same pixels, not a copy
  hits_.clear();
  const int cell_px = crop_.cell_px;
  const int last_row_px = std::min(rig_.scaled_row_px(crop_.last_row_px), rig_.height_px - cell_px);
  for (int row_px = 0; row_px <= last_row_px; row_px += cell_px)
    for (int column_px = 0; column_px + cell_px <= rig_.width_px; column_px += cell_px)
      add_cell(depth_m_, column_px, row_px);
  return hits_;
}

void FullStereoDetector::add_cell(const cv::Mat& depth_m, int column_px, int row_px) {
  cell_m_.clear();
  for (int v = row_px; v < row_px + crop_.cell_px; ++v) {
    const auto* row = depth_m.ptr<float>(v);
    for (int u = column_px; u < column_px + crop_.cell_px; ++u)
      if (row[u] >= crop_.minimum_depth_m && row[u] <= crop_.maximum_depth_m) cell_m_.push_back(row[u]);
  }
  if (cell_m_.size() < static_cast<std::size_t>(crop_.minimum_pixels_per_cell)) return;
  const auto middle = cell_m_.begin() + static_cast<std::ptrdiff_t>(cell_m_.size() / 2);
  std::nth_element(cell_m_.begin(), middle, cell_m_.end());
  const double z_m = *middle, center_px = 0.5 * (crop_.cell_px - 1);
  StereoHit hit;
  hit.column_px = column_px;
  hit.row_px = row_px;
  hit.disparity_px = rig_.disparity_px(z_m);
  hit.position_camera = {(column_px + center_px - rig_.center_left_x_px) * z_m / rig_.focal_px,
                         (row_px + center_px - rig_.center_y_px) * z_m / rig_.focal_px, z_m};
  if (hit.position_camera.y() > crop_.maximum_below_m) return;
  const double farther_px = hit.disparity_px - uncertainty_px;
  hit.depth = {rig_.depth_m(hit.disparity_px + uncertainty_px),
               farther_px > rig_.infinity_disparity_px() ? rig_.depth_m(farther_px) : crop_.maximum_depth_m};
  hits_.push_back(hit);
}

}  // namespace understory
