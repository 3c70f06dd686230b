#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scenarios/evaluation/ground_truth.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace understory {

/// A detector's precision (hits that are true) and recall (expected blocks that were hit). In woods many true
/// hits lie on leaves and on the ground, which flatters the precision: trunk precision leaves those out: it
/// is true hits on obstacles over these and all false hits.
struct Rates {
  Share precision, recall, trunk_precision = {};

  void add(const Rates& other) {
    precision.add(other.precision);
    recall.add(other.recall);
    trunk_precision.add(other.trunk_precision);
  }
  double f_score() const;  ///< harmonic mean of both
};

/// How near to the claimed depth the truth must lie: metres, or the interval that one pixel leaves open.
inline constexpr std::array<double, 3> tolerances_m{0.25, 0.50, 1.00};
inline constexpr std::size_t tolerance_count = 4, one_pixel = 3;
inline constexpr std::array<const char*, tolerance_count> tolerance_names{"0.25 m", "0.50 m", "1.00 m",
                                                                          "one pixel"};

/// The expected blocks of one frame, at each tolerance: the same for every detector.
using DueBlocks = std::array<std::vector<ExpectedBlock>, tolerance_count>;
DueBlocks due_blocks(const TrueImages& truth, const DetectionGrid& grid);

/// Whether the truth in a hit's block confirms it, at each tolerance. Ground counts as true.
std::array<bool, tolerance_count> true_within(const StereoHit& hit, const TrueImages& truth,
                                              const DetectionGrid& grid);

/// What a false hit lies on: "sky", "ground", "trunk, nearer", "edge of trunk" (its block holds an obstacle
/// and something at least a metre farther). `kinds`: by object number; "surface" if unknown.
std::string lies_on(const StereoHit& hit, const TrueImages& truth, const std::map<int, std::string>& kinds);

/// Adds one frame's hits to the rates at one pixel. `expected`: expected_blocks of the frame.
void count_one_pixel(const TrueImages& truth, const DetectionGrid& grid,
                     const std::vector<ExpectedBlock>& expected, const std::vector<StereoHit>& hits,
                     Rates& rates);

/// Detections of one algorithm against the truth. Tallies of recordings add up.
struct VisionTally {
  double seconds = 0;
  std::array<Rates, tolerance_count> rates;
  std::map<std::string, std::int64_t> false_on;  ///< false positives, by what they lie on
  /// "kind", "distance" (true, of the block), "lateral offset" (of the block from the optical axis),
  /// "lighting" (mean gray of the image), "speed", "bank"; at one pixel, each by its bins' names, which sort.
  std::map<std::string, std::map<std::string, Rates>> parts;
  /// Obstacle blocks of any depth, in bins of half a metre from 0, and how many have a hit.
  std::vector<Share> response;
  /// Over the image, a cell per block: true positives at one pixel, false positives, due blocks.
  std::vector<std::int64_t> true_positives_at, false_positives_at, expected_at;
  int columns = 0;

  void add(const VisionTally& other);
  const Rates& at_one_pixel() const { return rates[one_pixel]; }
  double false_per_second() const;
};

/// Adds one frame's hits. `due`: due_blocks of the frame.
void tally(const EvaluationFrame& frame, const DetectionGrid& grid, const StereoRig& rig,
           const std::map<int, std::string>& kinds, const DueBlocks& due, const std::vector<StereoHit>& hits,
           VisionTally& tally);

}  // namespace understory
