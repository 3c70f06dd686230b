#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "perception/stereo_rig.hpp"
#include "scenarios/detect/posed_map.hpp"
#include "scenarios/evaluation/ground_truth.hpp"

namespace understory {

/// Distances in the form of the paper's histograms (Barry & Tedrake 2015): bins of half a metre to 10 m,
/// everything farther in a last one, and those that had nothing to be compared with.
struct DistanceHistogram {
  static constexpr double bin_m = 0.5;
  static constexpr std::size_t bin_count = 21;
  std::array<std::int64_t, bin_count> bins{};  ///< a distance on an edge belongs to the nearer bin
  std::int64_t no_match = 0;

  /// Infinity is no match.
  void add(double distance_m);
  void add(const DistanceHistogram& other);
  std::int64_t total() const;  ///< no_match included
  /// Of all, no_match included, those within `limit_m`, a whole number of bins.
  double share_within(double limit_m) const;
  double share_without_match() const;
};

/// From each of `from` the distance to the nearest of `to`, m; +infinity where `to` is empty.
std::vector<double> nearest_distances_m(const std::vector<Eigen::Vector3d>& from,
                                        const std::vector<Eigen::Vector3d>& to);

/// The three evaluations of the paper (docs/sources.md [1]), which have StereoBM for truth.
struct PublishedScores {
  DistanceHistogram single_frame;     ///< 1: from each hit to StereoBM's points near the detection depth
  DistanceHistogram false_positives;  ///< 2: from each remembered point in view to StereoBM's points
  DistanceHistogram false_negatives;  ///< 3: from each of StereoBM's near points to the remembered ones

  void add(const PublishedScores& other);
};

/// One detector's hits through the three evaluations, along one recording.
class PublishedEvaluations {
 public:
  PublishedEvaluations(const StereoRig& rig, const DetectionGrid& grid, const LocalMapConfig& map);

  /// Every frame: carries the hits in the map, as in flight, along the flight's estimated poses.
  void remember(const EvaluationFrame& frame, const std::vector<StereoHit>& hits);
  /// Frames on which StereoBM was run: `depth_m` is its result (CV_32FC1, 0 where nothing), after remember().
  void compare(const EvaluationFrame& frame, const std::vector<StereoHit>& hits, const cv::Mat& depth_m);

  const PublishedScores& scores() const { return scores_; }

 private:
  StereoRig rig_;
  DetectionGrid grid_;
  PosedMap map_;
  PublishedScores scores_;
};

}  // namespace understory
