#include "perception/block_matching.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "perception/frame_views.hpp"

namespace understory {

BlockMatching::BlockMatching(const StereoRig& rig, const BlockMatchingConfig& config)
    : rig_(rig), config_(config), matcher_(cv::StereoBM::create(config.disparities, config.window_px)) {
  // The same depth the pushbroom detector works at: that of the nearest whole disparity.
  const double detection_m = rig.depth_m(std::round(rig.disparity_px(rig.detection_depth_m)));
  least_disparity_px_ = rig.disparity_px(detection_m + config.crop_m);
  greatest_disparity_px_ = rig.disparity_px(std::max(detection_m - config.crop_m, 0.01));
  matcher_->setMinDisparity(config.min_disparity_px);
  matcher_->setTextureThreshold(config.texture_threshold);
  matcher_->setUniquenessRatio(config.uniqueness_percent);
  matcher_->setPreFilterSize(config.prefilter_size_px);
  matcher_->setPreFilterCap(config.prefilter_cap);
  matcher_->setSpeckleWindowSize(config.speckle_window_px);
  matcher_->setSpeckleRange(config.speckle_range);
}

const std::vector<StereoHit>& BlockMatching::detect(const StereoFrame& frame) {
  view_of(frame.left, rig_);  // for their assertions
  view_of(frame.right, rig_);
  matcher_->compute(frame.left, frame.right, disparity_);
  hits_.clear();
  for (int row_px = 0; row_px + config_.cell_px <= rig_.height_px; row_px += config_.cell_px)
    for (int column_px = 0; column_px + config_.cell_px <= rig_.width_px; column_px += config_.cell_px)
      add_cell(column_px, row_px);
  return hits_;
}

void BlockMatching::add_cell(int column_px, int row_px) {
  cell_.clear();
  for (int v = row_px; v < row_px + config_.cell_px; ++v) {
    const auto* row = disparity_.ptr<std::int16_t>(v);
    for (int u = column_px; u < column_px + config_.cell_px; ++u) {
      const double disparity_px =
          row[u] / 16.0;  // unmatched pixels lie below the least disparity of the search
      if (disparity_px >= std::max<double>(least_disparity_px_, config_.min_disparity_px) &&
          disparity_px <= greatest_disparity_px_)
        cell_.push_back(row[u]);
    }
  }
  if (cell_.size() < static_cast<std::size_t>(config_.least_pixels_per_cell)) return;
  const auto middle = cell_.begin() + static_cast<std::ptrdiff_t>(cell_.size() / 2);
  std::nth_element(cell_.begin(), middle, cell_.end());
  StereoHit hit;
  hit.column_px = column_px;
  hit.row_px = row_px;
  hit.disparity_px = *middle / 16.0;
  const double depth_m = rig_.depth_m(hit.disparity_px), center_px = 0.5 * (config_.cell_px - 1);
  hit.position_camera = {(column_px + center_px - rig_.center_left_x_px) * depth_m / rig_.focal_px,
                         (row_px + center_px - rig_.center_y_px) * depth_m / rig_.focal_px, depth_m};
  hits_.push_back(hit);
}

}  // namespace understory
