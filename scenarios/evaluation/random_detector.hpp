#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "perception/obstacle_detector.hpp"
#include "perception/stereo_rig.hpp"
#include "scenarios/evaluation/detection_grid.hpp"

namespace understory {

/// Says "here" at random blocks of the grid, at the first depth looked at: the paper's measure of how little
/// a score means (Barry & Tedrake 2015, evaluations 2 and 3).
class RandomDetector : public ObstacleDetector {
 public:
  RandomDetector(const StereoRig& rig, const DetectionGrid& grid, std::uint64_t seed);
  /// How many hits the next frame gets: as many as the detector has that it is compared with.
  void set_count(std::size_t count) { count_ = count; }
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override;

 private:
  StereoRig rig_;
  DetectionGrid grid_;
  std::mt19937_64 generator_;
  std::size_t count_ = 0;
  std::vector<StereoHit> hits_;
};

/// A hit on the grid's block at its first depth looked at: as a detector would put it.
StereoHit hit_on_block(const StereoRig& rig, const LookedAtDepth& depth, int column_px, int row_px);

}  // namespace understory
