#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "perception/map/local_map.hpp"
#include "perception/stereo_rig.hpp"
#include "scenarios/evaluation/detection_grid.hpp"
#include "scenarios/evaluation/distance_histogram.hpp"
#include "scenarios/evaluation/evaluation_frame.hpp"

namespace understory {

/// The three evaluations of the paper (docs/sources.md [1]), which have StereoBM for truth.
struct PublishedScores {
  DistanceHistogram single_frame;     ///< 1: from each hit to StereoBM's points near the detection depth
  DistanceHistogram false_positives;  ///< 2: from each remembered point in view to StereoBM's points
  DistanceHistogram false_negatives;  ///< 3: from each of StereoBM's near points to the remembered ones

  void add(const PublishedScores& other);
};

/// What the paper measured, shares of 1.
struct PublishedFigures {
  double single_within_half_m = 0.609, single_within_1_m = 0.712, single_no_match = 0.082;
  double remembered_within_half_m = 0.748, remembered_within_1_m = 0.926;
  double random_within_half_m = 0.012, random_within_1_m = 0.032;
  double missed_by_1_m = 0.324, found_within_2_m = 0.913, random_missed_by_1_m = 0.86;
};

/// One detector's hits through the three evaluations, along one recording.
class PublishedEvaluations {
 public:
  PublishedEvaluations(const StereoRig& rig, const DetectionGrid& grid, const LocalMapConfig& map);

  /// Every frame: carries the hits in the map, as in flight, along where the flight believed to be.
  void remember(const EvaluationFrame& frame, const std::vector<StereoHit>& hits);
  /// Frames on which StereoBM was run: `depth_m` is what it said (CV_32FC1, 0 where nothing), after remember.
  void compare(const EvaluationFrame& frame, const std::vector<StereoHit>& hits, const cv::Mat& depth_m);

  const PublishedScores& scores() const { return scores_; }

 private:
  StereoRig rig_;
  DetectionGrid grid_;
  LocalMap map_;
  std::optional<Eigen::Isometry3d> T_odometry_camera_;  ///< of the newest frame remembered
  double distance_flown_m_ = 0;
  PublishedScores scores_;
};

}  // namespace understory
