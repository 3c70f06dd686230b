#include "perception/pushbroom_stereo.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "perception/assertion.hpp"
#include "perception/block_score.hpp"
#include "perception/frame_views.hpp"
#include "perception/isolation.hpp"

namespace understory {
namespace {

int whole(double pixels) { return static_cast<int>(std::lround(pixels)); }

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
    : rig_(rig), config_(config), infinity_px_(whole(rig.infinity_disparity_px())) {
  std::vector<double> depths_m = config.depths_m;
  if (depths_m.empty()) depths_m.push_back(rig.detection_depth_m);
  for (const double asked_m : depths_m) {
    const int px = whole(rig.disparity_px(asked_m));
    assert_always(px > rig.infinity_disparity_px() + 1, "detection depth within a pixel of infinity");
    depths_.push_back({px, rig.depth_m(px), {rig.depth_m(px + 1), rig.depth_m(px - 1)}});
  }
  assert_always(config.stride_px > 0 && config.invariance_row_step_px > 0, "strides must be positive");
  for (int i = 0; i < config.threads; ++i) kernels_.emplace_back(block_rule());
}

BlockRule PushbroomStereo::block_rule() const {
  BlockRule rule;
  rule.width_px = rig_.width_px;
  rule.height_px = rig_.height_px;
  rule.stride_px = config_.stride_px;
  rule.last_row_px = config_.last_row_px;
  for (const Depth& depth : depths_)
    rule.disparities.push_back(
        {depth.disparity_px, config_.least_edge_sum, score_limit_units(config_.score_limit)});
  rule.horizontal_invariance = config_.horizontal_invariance;
  rule.infinity_px = infinity_px_;
  rule.window = {config_.invariance_columns_px, config_.invariance_rows_px, config_.invariance_row_step_px,
                 config_.least_edge_sum, score_limit_units(config_.invariance_score_limit)};
  rule.uniqueness = config_.uniqueness;
  rule.uniqueness_ratio = config_.uniqueness_ratio;
  rule.least_disparity_px = infinity_px_;
  rule.greatest_disparity_px =
      static_cast<int>(std::floor(rig_.disparity_px(config_.uniqueness_least_depth_m)));
  return rule;
}

const std::vector<StereoHit>& PushbroomStereo::detect(const StereoFrame& frame) {
  const GrayView left = view_of(frame.left, rig_), right = view_of(frame.right, rig_);
  const int strips = kernels_.front().strip_count(), threads = static_cast<int>(kernels_.size());
  bands_.resize(kernels_.size());
  const auto search = [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    bands_[index] = &kernels_[index].search(left, right, strips * i / threads, strips * (i + 1) / threads);
  };
  if (threads == 1) {
    search(0);
  } else {
    tbb::parallel_for(0, threads, search, tbb::static_partitioner());
  }
  all_hits_.clear();
  for (const auto* band : bands_)
    for (const BlockMatch& match : *band) all_hits_.push_back(hit_of(match));
  if (!config_.isolation) return all_hits_;
  without_isolated(all_hits_, config_.isolation_least_points, config_.isolation_radius_m, hits_);
  return hits_;
}

StereoHit PushbroomStereo::hit_of(const BlockMatch& match) const {
  const Depth& depth = depths_[static_cast<std::size_t>(match.disparity)];
  const double center_px = 0.5 * (block_px - 1);
  StereoHit hit;
  hit.position_camera = {
      (match.column_px + center_px - rig_.center_left_x_px) * depth.depth_m / rig_.focal_px,
      (match.row_px + center_px - rig_.center_y_px) * depth.depth_m / rig_.focal_px, depth.depth_m};
  hit.column_px = match.column_px;
  hit.row_px = match.row_px;
  hit.disparity_px = depth.disparity_px;
  hit.edge_sum = match.left_edge_sum + match.right_edge_sum;
  hit.score = match.sad / hit.edge_sum;
  hit.depth = depth.interval;
  return hit;
}

}  // namespace understory
