#include "scenarios/parts/synthetic_detector.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "perception/field_visitor.hpp"

namespace understory {
SyntheticDetector::SyntheticDetector(const StereoRig& rig, const std::vector<Obstacle>& obstacles,
                                     const TruthHistory& history, const SyntheticConfig& config,
                                     const DepthInterval& reach, std::uint64_t seed)
    : rig_(rig),
      config_(config),
      intervals_(config.depths_m.empty() ? std::vector{reach} : intervals_around(config.depths_m, rig)),
      truth_(rig, obstacles, history, intervals_),
      generator_(seed) {
  std::map<int, std::size_t> trees;
  std::size_t things = 0;
  for (const Obstacle& obstacle : obstacles) {
    const auto [tree, is_new] =
        obstacle.tree < 0 ? std::pair(trees.end(), true) : trees.try_emplace(obstacle.tree, things);
    thing_of_.push_back(is_new ? things++ : tree->second);
  }
  for (std::size_t thing = 0; thing < things; ++thing) missed_.push_back(chance(config_.missed_obstacles));
}

const std::vector<StereoHit>& SyntheticDetector::detect(const StereoFrame& frame) {
  const std::vector<StereoHit>& seen = truth_.detect(frame);
  std::normal_distribution<double> error_px(0, config_.disparity_error_px);
  std::map<std::size_t, bool> missed_now;
  hits_.clear();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const std::size_t thing = thing_of_[truth_.obstacles_of_hits()[i]];
    if (missed_[thing]) continue;
    const auto [now, is_new] = missed_now.try_emplace(thing, false);
    if (is_new) now->second = chance(config_.missed_frames);
    if (now->second || chance(config_.missed_blocks)) continue;
    StereoHit hit = seen[i];
    if (config_.disparity_error_px > 0) {
      hit.disparity_px += error_px(generator_);
      if (hit.disparity_px <= rig_.infinity_disparity_px()) continue;  // it would lie beyond infinity
      hit.position_camera *= rig_.depth_m(hit.disparity_px) / hit.position_camera.z();
    }
    hits_.push_back(hit);
  }
  if (config_.false_points > 0) add_false_points();
  return hits_;
}

/// Anywhere in the image, at any of the depths that are looked at.
void SyntheticDetector::add_false_points() {
  std::uniform_int_distribution<int> row(0, truth_.rows() - 1), column(0, truth_.columns() - 1);
  std::uniform_int_distribution<std::size_t> interval(0, intervals_.size() - 1);
  const int count = std::poisson_distribution<int>(config_.false_points)(generator_);
  for (int i = 0; i < count; ++i) {
    const auto& [near_m, far_m] = intervals_[interval(generator_)];
    const double end_m = std::max(near_m, std::min(far_m, 100.0));
    const double depth_m = std::uniform_real_distribution<double>(near_m, end_m)(generator_);
    hits_.push_back(truth_.hit_at(row(generator_), column(generator_), depth_m));
  }
  std::ranges::stable_sort(hits_, {},
                           [](const StereoHit& hit) { return std::pair(hit.row_px, hit.column_px); });
}

void visit_fields(FieldVisitor& visit, SyntheticConfig& config) {
  visit(
      "depths_m", config.depths_m, 0.1, 1000.0,
      "Depths that it looks at, each to within one pixel of disparity; empty: all from "
      "perception.full_stereo.minimum_depth_m to maximum_depth_m. How often it looks and how late it answers "
      "are cameras.rate_hz and cameras.latency_s.");
  visit("missed_obstacles", config.missed_obstacles, 0.0, 1.0,
        "share of the obstacles that it never sees; a tree of woods counts as one");
  visit("missed_frames", config.missed_frames, 0.0, 1.0,
        "share of the frames in which it does not see an obstacle, drawn for each obstacle");
  visit("missed_blocks", config.missed_blocks, 0.0, 1.0,
        "share of an obstacle's blocks of 5 x 5 pixels that it does not see, drawn in each frame");
  visit("false_points", config.false_points, 0.0, 1000.0,
        "mean number of points in a frame where nothing stands (Poisson), anywhere in the image");
  visit("disparity_error_px", config.disparity_error_px, 0.0, 20.0,
        "Standard deviation of the disparity of a hit. At depth z it moves a point by about z^2 / (f b) of "
        "this, with the rig's focal length f (px) and baseline b (m).");
}

}  // namespace understory
