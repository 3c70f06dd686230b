#include "perception/pushbroom/pushbroom_stereo.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "perception/assertion.hpp"
#include "perception/field_visitor.hpp"
#include "perception/pushbroom/frame_views.hpp"

namespace understory {
namespace {

int whole(double pixels) { return static_cast<int>(std::lround(pixels)); }

/// Minimum of the parabola through a match's SAD and those beside it, in pixels of disparity; 0 where the
/// neighbours are not known or one of them is better.
double vertex_px(const BlockMatch& match) {
  if (match.sad_below < match.sad || match.sad_above < match.sad) return 0;
  const int bend = match.sad_below - 2 * match.sad + match.sad_above;
  return bend > 0 ? 0.5 * (match.sad_below - match.sad_above) / bend : 0;
}

/// The whole disparities u_left - u_right that the rule looks at. The original's files state u_right -
/// u_left.
std::vector<int> disparities_of(const PushbroomConfig& config, const StereoRig& rig) {
  std::vector<int> disparities_px;
  for (const int stated_px : config.disparities_px) disparities_px.push_back(-stated_px);
  for (const double depth_m : config.depths_m) disparities_px.push_back(whole(rig.disparity_px(depth_m)));
  if (disparities_px.empty()) disparities_px.push_back(whole(rig.disparity_px(rig.detection_depth_m)));
  return disparities_px;
}

template <typename... Parts>
std::string text_of(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

/// The visitor that finds a number out of its range.
struct RangeCheck : FieldVisitor {
  void numbers(std::string_view name, FieldNumbers& numbers, std::string_view) override {
    for (const double value : numbers.values)
      if (!(value >= numbers.minimum && value <= numbers.maximum))  // written so that nan is refused
        fault = text_of(name, ": must be from ", numbers.minimum, " to ", numbers.maximum, ", is ", value);
  }
  std::string fault;
};

/// Looks outwards from the hit in the frame's order: neighbours in the image are near in the order too, so
/// hits with company are settled after a few steps, and hits without are few, since they keep their distance.
bool has_company(const std::vector<StereoHit>& hits, std::size_t index, int minimum_points, double radius_m) {
  const Eigen::Vector3d& here = hits[index].position_camera;
  int found = 1;
  const auto count = [&](std::size_t other) {
    if ((hits[other].position_camera - here).squaredNorm() <= radius_m * radius_m) ++found;
  };
  for (std::size_t step = 1; found < minimum_points && (step <= index || index + step < hits.size());
       ++step) {
    if (index + step < hits.size()) count(index + step);
    if (step <= index) count(index - step);
  }
  return found >= minimum_points;
}

}  // namespace

void without_isolated(const std::vector<StereoHit>& hits, int minimum_points, double radius_m,
                      std::vector<StereoHit>& kept) {
  kept.clear();
  for (std::size_t index = 0; index < hits.size(); ++index)
    if (has_company(hits, index, minimum_points, radius_m)) kept.push_back(hits[index]);
}

std::vector<double> stated_depths_m(const PushbroomConfig& config, const StereoRig& rig) {
  std::vector<double> depths_m = config.depths_m;
  for (const int stated_px : config.disparities_px) depths_m.push_back(rig.depth_m(-stated_px));
  return depths_m;
}

std::string fault_of(const PushbroomConfig& config, const StereoRig& rig) {
  RangeCheck range;
  PushbroomConfig visited = config;  // visitors take fields they could change
  visit_fields(range, visited);
  range("depths_m", visited.depths_m, 0.1, 1000.0);
  if (!range.fault.empty()) return range.fault;
  if (!config.depths_m.empty() && !config.disparities_px.empty())
    return "disparities_px and depths_m exclude each other: name one of them";
  const std::vector<int> disparities_px = disparities_of(config, rig);
  for (const auto& [name, thresholds] :
       {std::pair("depths_minimum_edge_sum", &config.depths_minimum_edge_sum),
        std::pair("depths_score_limit", &config.depths_score_limit)})
    if (!thresholds->empty() && thresholds->size() != disparities_px.size())
      return text_of(name, ": must be empty or have one value a depth (", disparities_px.size(), "), has ",
                     thresholds->size());
  for (std::size_t i = 0; i < disparities_px.size(); ++i) {
    if (rig.can_look_at(disparities_px[i])) continue;
    if (!config.disparities_px.empty())
      return text_of("disparities_px: the rig ", rig.name, " cannot look at ", config.disparities_px[i],
                     " px (u_right - u_left)");
    return text_of("depths_m: the rig ", rig.name, " cannot look at ",
                   config.depths_m.empty() ? rig.detection_depth_m : config.depths_m[i], " m");
  }
  return "";
}

PushbroomConfig original_pushbroom() { return {}; }

PushbroomConfig robust_pushbroom() {
  PushbroomConfig config;
  config.last_row_px = 205;
  config.right_margin_px = 0;
  config.minimum_edge_sum = 215;
  config.score_limit = 0.25;
  config.horizontal_invariance = false;
  config.uniqueness = true;
  config.isolation = true;
  return config;
}

PushbroomConfig tuned_pushbroom(std::string_view rig) {
  PushbroomConfig config = robust_pushbroom();
  if (rig == "long") {
    config.minimum_edge_sum = 398;
    config.score_limit = 0.126899;
    config.uniqueness_ratio = 1.35321;
    config.uniqueness_minimum_depth_m = 1.66256;
    config.isolation_minimum_points = 6;
    config.isolation_radius_m = 0.890088;
  } else if (rig == "paper") {
    config.minimum_edge_sum = 406;
    config.score_limit = 0.200216;
    config.uniqueness_ratio = 1.19411;
    config.uniqueness_minimum_depth_m = 2.15428;
    config.isolation_minimum_points = 8;
    config.isolation_radius_m = 0.621281;
    config.depths_m = {9.1, 4.8};
  }
  return config;
}

PushbroomConfig woods_pushbroom(std::string_view rig) {
  PushbroomConfig config = tuned_pushbroom(rig);
  if (rig == "paper") {
    config.minimum_edge_sum = 74;
    config.score_limit = 0.26;
    config.uniqueness_ratio = 1.35;
    config.uniqueness_minimum_depth_m = 2.9;
    config.isolation_minimum_points = 12;
    config.isolation_radius_m = 0.5;
  } else if (rig == "long") {
    config.minimum_edge_sum = 111;
    config.score_limit = 0.259742;
    config.uniqueness_ratio = 1.5332;
    config.uniqueness_minimum_depth_m = 1.90221;
    config.isolation_minimum_points = 13;
    config.isolation_radius_m = 0.524387;
  } else {
    return config;
  }
  config.stride_px = 3;
  config.cell_px = 5;
  return config;
}

PushbroomStereo::PushbroomStereo(const StereoRig& rig, const PushbroomConfig& config)
    : rig_(rig),
      config_(config),
      infinity_px_(config.infinity_px ? -*config.infinity_px : whole(rig.infinity_disparity_px())) {
  if (const std::string fault = fault_of(config, rig); !fault.empty())
    throw std::invalid_argument("PushbroomStereo: " + fault);
  for (const int px : disparities_of(config, rig))
    depths_.push_back({px, rig.depth_m(px), rig.depths_around(px)});
  for (int i = 0; i < config.threads; ++i) bands_.push_back({PushbroomKernel(block_rule()), {}, {}});
}

PushbroomStereo::PushbroomStereo(const CalibratedRig& rig, const PushbroomConfig& config)
    : PushbroomStereo(rig.rig, config) {
  if (!rig.calibration) return;
  const StereoCalibration& calibration = *rig.calibration;
  const int width = calibration.width_px, height = calibration.height_px;
  const ReadColumns columns = read_columns(block_rule());
  maps_.emplace(Maps{{nearest_places(calibration.left, width, height), width, height, columns.left_first_px,
                      columns.left_last_px},
                     {nearest_places(calibration.right, width, height), width, height, columns.right_first_px,
                      columns.right_last_px}});
  for (Band& band : bands_)
    for (auto* image : {&band.left, &band.right})
      image->resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

BlockRule PushbroomStereo::block_rule() const {
  BlockRule rule;
  rule.width_px = rig_.width_px;
  rule.height_px = rig_.height_px;
  rule.stride_px = config_.stride_px;
  rule.last_row_px = rig_.scaled_row_px(config_.last_row_px);
  rule.right_margin_px = config_.right_margin_px;
  for (std::size_t i = 0; i < depths_.size(); ++i) {
    const double edges = config_.depths_minimum_edge_sum.empty() ? config_.minimum_edge_sum
                                                                 : config_.depths_minimum_edge_sum[i];
    const double limit =
        config_.depths_score_limit.empty() ? config_.score_limit : config_.depths_score_limit[i];
    rule.disparities.push_back({depths_[i].disparity_px, whole(edges), score_limit_units(limit)});
  }
  rule.horizontal_invariance = config_.horizontal_invariance;
  rule.infinity_px = infinity_px_;
  rule.window = {config_.invariance_columns_px, config_.invariance_rows_px, config_.invariance_row_step_px,
                 config_.minimum_edge_sum, score_limit_units(config_.invariance_score_limit)};
  rule.neighbours = config_.subpixel;
  rule.uniqueness = config_.uniqueness;
  rule.uniqueness_ratio = config_.uniqueness_ratio;
  rule.minimum_disparity_px = infinity_px_;
  rule.maximum_disparity_px =
      static_cast<int>(std::floor(rig_.disparity_px(config_.uniqueness_minimum_depth_m)));
  return rule;
}

const std::vector<StereoHit>& PushbroomStereo::detect(const StereoFrame& frame) {
  const GrayView left = view_of(frame.left, rig_), right = view_of(frame.right, rig_);
  if (maps_) {
    maps_->left.prepare(left.stride);
    maps_->right.prepare(right.stride);
  }
  const int threads = static_cast<int>(bands_.size());
  if (threads == 1) {
    search(left, right, 0);
  } else {
    tbb::parallel_for(
        0, threads, [&](int index) { search(left, right, index); }, tbb::static_partitioner());
  }
  all_hits_.clear();
  for (const Band& band : bands_)
    for (const BlockMatch& match : *band.matches) all_hits_.push_back(hit_of(match));
  if (config_.isolation)
    without_isolated(all_hits_, config_.isolation_minimum_points, config_.isolation_radius_m, hits_);
  else
    hits_.swap(all_hits_);
  if (config_.cell_px > 0) keep_best_of_cells();
  return hits_;
}

void PushbroomStereo::keep_best_of_cells() {
  const int columns = rig_.width_px / config_.cell_px + 1, rows = rig_.height_px / config_.cell_px + 1;
  const auto cell_of = [&](const StereoHit& hit) {
    const auto depth =
        std::ranges::find(depths_, hit.depth.near_m, [](const Depth& one) { return one.interval.near_m; });
    const int row = (hit.row_px + block_px / 2) / config_.cell_px,
              column = (hit.column_px + block_px / 2) / config_.cell_px;
    return static_cast<std::size_t>(((depth - depths_.begin()) * rows + row) * columns + column);
  };
  constexpr std::size_t none = SIZE_MAX;
  best_of_cells_.assign(depths_.size() * static_cast<std::size_t>(rows * columns), none);
  for (std::size_t i = 0; i < hits_.size(); ++i) {
    std::size_t& best = best_of_cells_[cell_of(hits_[i])];
    if (best == none || hits_[i].score < hits_[best].score) best = i;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < hits_.size(); ++i)
    if (best_of_cells_[cell_of(hits_[i])] == i) hits_[kept++] = hits_[i];
  hits_.resize(kept);
}

void PushbroomStereo::search(const GrayView& left, const GrayView& right, int index) {
  Band& band = bands_[static_cast<std::size_t>(index)];
  const int strips = band.kernel.strip_count(), bands = static_cast<int>(bands_.size());
  const int first = strips * index / bands, last = strips * (index + 1) / bands;
  if (!maps_) {
    band.matches = &band.kernel.search(left, right, first, last, true);
    return;
  }
  // The edge map looks one row beyond the blocks, and the invariance window's beyond its own.
  const int stride_px = config_.stride_px, rows_end = (last - 1) * stride_px + block_px;
  const auto rectify = [&](const ByteRemap& map, const GrayView& raw, int beyond, std::uint8_t* output) {
    map.apply(raw, std::max(0, first * stride_px - beyond), std::min(rig_.height_px, rows_end + beyond),
              output, rig_.width_px);
  };
  rectify(maps_->left, left, 1, band.left.data());
  rectify(maps_->right, right, 1 + (config_.horizontal_invariance ? config_.invariance_rows_px : 0),
          band.right.data());
  band.matches = &band.kernel.search({band.left.data(), rig_.width_px, rig_.width_px, rig_.height_px},
                                     {band.right.data(), rig_.width_px, rig_.width_px, rig_.height_px}, first,
                                     last, false);
}

StereoHit PushbroomStereo::hit_of(const BlockMatch& match) const {
  const Depth& depth = depths_[static_cast<std::size_t>(match.disparity)];
  const double center_px = 0.5 * (block_px - 1);
  StereoHit hit;
  hit.column_px = match.column_px;
  hit.row_px = match.row_px;
  hit.disparity_px = depth.disparity_px + vertex_px(match);
  hit.edge_sum = match.left_edge_sum + match.right_edge_sum;
  hit.score = match.sad / hit.edge_sum;
  hit.depth = depth.interval;
  const double depth_m =
      hit.disparity_px == depth.disparity_px ? depth.depth_m : rig_.depth_m(hit.disparity_px);
  hit.position_camera = {(match.column_px + center_px - rig_.center_left_x_px) * depth_m / rig_.focal_px,
                         (match.row_px + center_px - rig_.center_y_px) * depth_m / rig_.focal_px, depth_m};
  return hit;
}

}  // namespace understory
