#include "perception/full_stereo/full_stereo.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <opencv2/core.hpp>

#include "perception/assertion.hpp"
#include "perception/pushbroom/frame_views.hpp"

namespace understory {
namespace {

constexpr double steps_per_px = cv::StereoMatcher::DISP_SCALE;
constexpr double uncertainty_px = 0.5;
constexpr double unlimited_m = 1000;

int mode_of(SgbmPaths paths) {
  switch (paths) {
    case SgbmPaths::three:
      return cv::StereoSGBM::MODE_SGBM_3WAY;
    case SgbmPaths::five:
      return cv::StereoSGBM::MODE_SGBM;
    case SgbmPaths::eight:
      return cv::StereoSGBM::MODE_HH;
  }
  return cv::StereoSGBM::MODE_SGBM;
}

/// `cell_m`: room to work in.
void add_cell(const cv::Mat& depth_m, const StereoRig& rig, const FullStereoCrop& crop, int column_px,
              int row_px, std::vector<float>& cell_m, std::vector<StereoHit>& hits) {
  cell_m.clear();
  for (int v = row_px; v < row_px + crop.cell_px; ++v) {
    const auto* row = depth_m.ptr<float>(v);
    for (int u = column_px; u < column_px + crop.cell_px; ++u)
      if (row[u] >= crop.minimum_depth_m && row[u] <= crop.maximum_depth_m) cell_m.push_back(row[u]);
  }
  if (cell_m.size() < static_cast<std::size_t>(crop.minimum_pixels_per_cell)) return;
  const auto middle = cell_m.begin() + static_cast<std::ptrdiff_t>(cell_m.size() / 2);
  std::nth_element(cell_m.begin(), middle, cell_m.end());
  const double z_m = *middle, center_px = 0.5 * (crop.cell_px - 1);
  StereoHit hit;
  hit.column_px = column_px;
  hit.row_px = row_px;
  hit.disparity_px = rig.disparity_px(z_m);
  hit.position_camera = {(column_px + center_px - rig.center_left_x_px) * z_m / rig.focal_px,
                         (row_px + center_px - rig.center_y_px) * z_m / rig.focal_px, z_m};
  if (hit.position_camera.y() > crop.maximum_below_m) return;
  // Beyond half a pixel another whole disparity would have matched better.
  hit.depth = rig.depths_around(hit.disparity_px, uncertainty_px);
  if (!std::isfinite(hit.depth.far_m)) hit.depth.far_m = crop.maximum_depth_m;
  hits.push_back(hit);
}

}  // namespace

FullStereoDetector::FullStereoDetector(const StereoRig& rig, const FullStereoCrop& crop, int window_px,
                                       int min_disparity_px, int disparities)
    : rig_(rig),
      crop_(crop),
      min_disparity_px_(min_disparity_px),
      pad_px_(min_disparity_px + disparities + window_px / 2) {
  const auto shift_px = static_cast<int>(std::lround(rig.infinity_disparity_px()));
  left_from_px_ = std::max(shift_px, 0);
  right_from_px_ = std::max(-shift_px, 0);
  common_width_px_ = rig.width_px - std::abs(shift_px);
  remainder_px_ = rig.infinity_disparity_px() - shift_px;
  assert_always(window_px % 2 == 1 && disparities % 16 == 0 && min_disparity_px > 0,
                "full stereo wants an odd window and disparities in multiples of 16, from 1 px on");
  assert_always(common_width_px_ > window_px && rig.height_px > window_px,
                "the rig's infinity leaves its images no common part");
}

FullStereoDetector::FullStereoDetector(const StereoRig& rig, const StereoBmConfig& config,
                                       const FullStereoCrop& crop)
    : FullStereoDetector(rig, crop, config.window_px, config.min_disparity_px, config.disparities) {
  const auto matcher = cv::StereoBM::create(config.disparities, config.window_px);
  matcher->setMinDisparity(config.min_disparity_px);
  matcher->setTextureThreshold(config.texture_threshold);
  matcher->setUniquenessRatio(config.uniqueness_percent);
  matcher->setPreFilterSize(config.prefilter_size_px);
  matcher->setPreFilterCap(config.prefilter_cap);
  matcher->setSpeckleWindowSize(config.speckle_window_px);
  matcher->setSpeckleRange(config.speckle_range);
  matcher_ = matcher;
}

FullStereoDetector::FullStereoDetector(const StereoRig& rig, const StereoSgbmConfig& config,
                                       const FullStereoCrop& crop)
    : FullStereoDetector(rig, crop, config.window_px, config.min_disparity_px, config.disparities) {
  assert_always(config.smoothness_2 > config.smoothness_1, "StereoSGBM wants P2 greater than P1");
  const int area = config.window_px * config.window_px;
  matcher_ = cv::StereoSGBM::create(config.min_disparity_px, config.disparities, config.window_px,
                                    config.smoothness_1 * area, config.smoothness_2 * area,
                                    config.left_right_px, config.prefilter_cap, config.uniqueness_percent,
                                    config.speckle_window_px, config.speckle_range_px, mode_of(config.paths));
}

void FullStereoDetector::match(const StereoFrame& frame) {
  view_of(frame.left, rig_);  // for their assertions
  view_of(frame.right, rig_);
  // A border around part of an image is filled from the image, as far as it goes.
  const cv::Size common(common_width_px_, rig_.height_px);
  cv::copyMakeBorder(frame.left(cv::Rect({left_from_px_, 0}, common)), left_, 0, 0, pad_px_, 0,
                     cv::BORDER_REPLICATE);
  cv::copyMakeBorder(frame.right(cv::Rect({right_from_px_, 0}, common)), right_, 0, 0, pad_px_, 0,
                     cv::BORDER_REPLICATE);
  matcher_->compute(left_, right_, disparity_);
  depth_m_ = cv::Mat::zeros(rig_.height_px, rig_.width_px, CV_32FC1);
  const double scale_m = rig_.focal_px * rig_.baseline_m;
  for (int v = 0; v < rig_.height_px; ++v) {
    const auto* found = disparity_.ptr<std::int16_t>(v) + pad_px_;
    auto* depth = depth_m_.ptr<float>(v) + left_from_px_;
    for (int u = 0; u < common_width_px_; ++u) {
      const double disparity_px = found[u] / steps_per_px;
      const double parallax_px = disparity_px - remainder_px_;
      // Unmatched pixels lie below the minimum disparity; beyond the right image's first column is padding.
      const bool is_matched = disparity_px >= min_disparity_px_ && disparity_px <= u + right_from_px_;
      if (is_matched && parallax_px > 0) depth[u] = static_cast<float>(scale_m / parallax_px);
    }
  }
}

FullStereoCrop one_pixel_crop(const StereoRig& rig) {
  const DepthInterval interval = rig.depths_around(std::round(rig.disparity_px(rig.detection_depth_m)));
  FullStereoCrop crop;
  crop.minimum_depth_m = interval.near_m;
  crop.maximum_depth_m = interval.far_m;
  crop.maximum_below_m = unlimited_m;  // the pushbroom's rows alone
  return crop;
}

const std::vector<StereoHit>& FullStereoDetector::detect(const StereoFrame& frame) {
  match(frame);
  hits_of_depth(depth_m_, rig_, crop_, hits_);
  return hits_;
}

void hits_of_depth(const cv::Mat& depth_m, const StereoRig& rig, const FullStereoCrop& crop,
                   std::vector<StereoHit>& hits) {
  hits.clear();
  std::vector<float> cell_m;
  const int cell_px = crop.cell_px;
  const int last_row_px = std::min(rig.scaled_row_px(crop.last_row_px), rig.height_px - cell_px);
  for (int row_px = 0; row_px <= last_row_px; row_px += cell_px)
    for (int column_px = 0; column_px + cell_px <= rig.width_px; column_px += cell_px)
      add_cell(depth_m, rig, crop, column_px, row_px, cell_m, hits);
}

}  // namespace understory
