#include "perception/pushbroom_stereo.hpp"

#include <algorithm>
#include <cmath>

#include "perception/assertion.hpp"
#include "perception/block_score.hpp"
#include "perception/frame_views.hpp"
#include "perception/isolation.hpp"

namespace understory {
namespace {

int whole(double pixels) { return static_cast<int>(std::lround(pixels)); }

UniquenessTest uniqueness_test(const StereoRig& rig, const PushbroomConfig& config, int detection_px) {
  const int infinity_px = whole(rig.infinity_disparity_px());
  const int nearest_px = static_cast<int>(std::floor(rig.disparity_px(config.uniqueness_least_depth_m)));
  return {detection_px, std::min(infinity_px, detection_px), std::max(nearest_px, detection_px),
          config.uniqueness_ratio};
}

int sum_of_block_columns(const std::vector<std::uint16_t>& sums, int column_px) {
  const std::uint16_t* first = sums.data() + column_px;
  return first[0] + first[1] + first[2] + first[3] + first[4];
}

}  // namespace

PushbroomConfig paper_rule() { return {}; }

PushbroomConfig robust_rule() {
  PushbroomConfig config;
  config.least_edge_sum = 215;
  config.score_limit = 0.25;
  config.horizontal_invariance = false;
  config.uniqueness = true;
  config.isolation = true;
  return config;
}

PushbroomStereo::PushbroomStereo(const StereoRig& rig, const PushbroomConfig& config)
    : rig_(rig),
      config_(config),
      disparity_px_(whole(rig.disparity_px(rig.detection_depth_m))),
      infinity_px_(whole(rig.infinity_disparity_px())),
      depth_m_(rig.depth_m(disparity_px_)),
      score_limit_units_(score_limit_units(config.score_limit)),
      uniqueness_(uniqueness_test(rig, config, disparity_px_)) {
  assert_always(disparity_px_ > rig.infinity_disparity_px() + 1,
                "detection depth within a pixel of infinity");
  assert_always(std::abs(disparity_px_) + block_px <= rig.width_px,
                "detection disparity wider than the image");
  assert_always(config.stride_px > 0 && config.invariance_row_step_px > 0, "strides must be positive");
  window_ = {config.invariance_columns_px, config.invariance_rows_px, config.invariance_row_step_px,
             config.least_edge_sum, score_limit_units(config.invariance_score_limit)};
}

DepthInterval PushbroomStereo::one_pixel_interval() const {
  return {rig_.depth_m(disparity_px_ + 1), rig_.depth_m(disparity_px_ - 1)};
}

std::vector<StereoHit> PushbroomStereo::detect(const StereoFrame& frame) {
  const GrayView left = view_of(frame.left, rig_), right = view_of(frame.right, rig_);
  edge_map(left, left_edges_);
  edge_map(right, right_edges_);
  std::vector<StereoHit> hits;
  const int last_row_px = std::min(config_.last_row_px, rig_.height_px - block_px);
  for (int row_px = 0; row_px <= last_row_px; row_px += config_.stride_px)
    detect_row(left, right, row_px, hits);
  if (config_.isolation)
    return without_isolated(hits, config_.isolation_least_points, config_.isolation_radius_m);
  return hits;
}

void PushbroomStereo::detect_row(const GrayView& left, const GrayView& right, int row_px,
                                 std::vector<StereoHit>& hits) {
  column_sums(view_of(left_edges_, left.width_px, left.height_px), row_px, left_sums_);
  column_sums(view_of(right_edges_, right.width_px, right.height_px), row_px, right_sums_);
  // Both the block and its partner at column - disparity must lie inside their images.
  const int first = std::max(0, disparity_px_);
  const int last = left.width_px - block_px + std::min(0, disparity_px_);
  for (int column_px = first; column_px <= last; column_px += config_.stride_px) {
    const int left_edge_sum = sum_of_block_columns(left_sums_, column_px);
    if (left_edge_sum < config_.least_edge_sum) continue;
    const int right_column_px = column_px - disparity_px_;
    const int right_edge_sum = sum_of_block_columns(right_sums_, right_column_px);
    if (right_edge_sum < config_.least_edge_sum) continue;
    const int sad = block_sad(left.row(row_px) + column_px, left.stride, right.row(row_px) + right_column_px,
                              right.stride);
    if (!scores_below(sad, left_edge_sum + right_edge_sum, score_limit_units_)) continue;
    if (!passes_filters(left, right, column_px, row_px, left_edge_sum)) continue;
    hits.push_back(hit_at(column_px, row_px, sad, left_edge_sum + right_edge_sum));
  }
}

bool PushbroomStereo::passes_filters(const GrayView& left, const GrayView& right, int column_px, int row_px,
                                     int left_edge_sum) {
  if (config_.uniqueness && !uniqueness_.unique(left, right, column_px, row_px)) return false;
  return !config_.horizontal_invariance ||
         !self_similar(left, right, view_of(right_edges_, right.width_px, right.height_px), column_px, row_px,
                       column_px - infinity_px_, left_edge_sum, window_);
}

StereoHit PushbroomStereo::hit_at(int column_px, int row_px, int sad, int edge_sum) const {
  const double center_px = 0.5 * (block_px - 1);
  StereoHit hit;
  hit.position_camera = {(column_px + center_px - rig_.center_left_x_px) * depth_m_ / rig_.focal_px,
                         (row_px + center_px - rig_.center_y_px) * depth_m_ / rig_.focal_px, depth_m_};
  hit.column_px = column_px;
  hit.row_px = row_px;
  hit.disparity_px = disparity_px_;
  hit.score = static_cast<double>(sad) / edge_sum;
  hit.edge_sum = edge_sum;
  return hit;
}

}  // namespace understory
