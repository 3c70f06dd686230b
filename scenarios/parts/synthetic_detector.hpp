#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "scenarios/parts/oracles.hpp"

namespace understory {

class FieldVisitor;

/// A detector described by what it can do (docs/limits.md). How often it looks and how late it answers are
/// the cameras' rate and latency.
struct SyntheticConfig {
  std::vector<double> depths_m = {};
  double missed_obstacles = 0;
  double missed_frames = 0;
  double missed_blocks = 0;
  double false_points = 0;
  double disparity_error_px = 0;
};

void visit_fields(FieldVisitor& visit, SyntheticConfig& config);

/// Hits made from the truth, with the faults of a described detector. It looks at no images. Of a tree of
/// woods all pieces are missed together. Hits are in the left camera's frame, from top to bottom.
class SyntheticDetector : public ObstacleDetector {
 public:
  /// As TrueDepth. `reach`: the depths that it sees if config.depths_m is empty. The same seed gives the same
  /// faults.
  SyntheticDetector(const StereoRig& rig, const std::vector<Obstacle>& obstacles, const TruthHistory& history,
                    const SyntheticConfig& config, const DepthInterval& reach, std::uint64_t seed);
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override;

 private:
  bool chance(double share) { return std::uniform_real_distribution<double>(0, 1)(generator_) < share; }
  void add_false_points();

  StereoRig rig_;
  SyntheticConfig config_;
  std::vector<DepthInterval> intervals_;
  TrueDepth truth_;
  std::mt19937_64 generator_;
  std::vector<std::size_t> thing_of_;  ///< of each obstacle: itself, or its tree
  std::vector<bool> missed_;           ///< of each thing: for good
  std::vector<StereoHit> hits_;
};

}  // namespace understory
