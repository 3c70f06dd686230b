#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "perception/stereo_frame.hpp"
#include "perception/stereo_hit.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// The first number of an obstacle in objects.csv: 0 is nothing, 1 the ground.
inline constexpr int first_obstacle = 2;

/// The truth of a frame's rectified left image.
struct TrueImages {
  cv::Mat depth_mm;  ///< CV_16UC1, along the optical axis; 0 where nothing is known or all is far
  cv::Mat objects;   ///< CV_16UC1, numbers of objects.csv; empty if the recording has no objects
  /// depth_mm where the right eye sees the same place, 0 where something nearer covers it there: no pair of
  /// eyes can match what one of them does not see.
  cv::Mat shared_depth_mm;
  std::vector<bool> soft = {};  ///< by number: whether the object does not stop the aircraft
  bool is_obstacle(std::uint16_t number) const {
    return number >= first_obstacle && (number >= soft.size() || !soft[number]);
  }
};

/// A thing of objects.csv: an obstacle between two points (world frame, m), or a piece of one, if several
/// lines have one number; soft objects have no geometry.
struct RecordedObject {
  int number = 0;  ///< its pixels' value
  std::string name;
  std::string kind;  ///< ground, trunk, branch, foliage, undergrowth, log, far_wood, post, crossbar, ...
  Eigen::Vector3d from_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_world = Eigen::Vector3d::Zero();
  double radius_m = 0;
  bool is_obstacle() const {
    return number >= first_obstacle && kind != "foliage" && kind != "undergrowth" && kind != "log" &&
           kind != "far_wood";
  }
};

/// A recorded moment and all that is known of it.
struct EvaluationFrame {
  StereoFrame pair;  ///< rectified
  TrueImages truth;  ///< empty where the recording has no depth
  /// Of the left camera, true; nothing where no pose covers the moment.
  std::optional<Eigen::Isometry3d> T_world_camera;
  /// The estimated pose of the flight, in its odometry frame; the true pose if there is no estimate.
  std::optional<Eigen::Isometry3d> T_odometry_camera;
  double speed_mps = 0;  ///< true; 0 where no pose is known
  double bank_rad = 0;   ///< the camera's rows against the horizon, 0 .. pi/2
  double mean_gray = 0;  ///< of the left image
};

/// Computes shared_depth_mm from depth_mm alone: every pixel is projected into the right image, and the
/// nearest at each place is kept. Objects beyond the left image's edge that cover something are not known.
cv::Mat shared_depth(const cv::Mat& depth_mm, const StereoRig& rig);

/// A detection says of 5x5 pixels "something stands at this depth". A fifth of them at that depth makes it
/// true: blocks at the edge of a trunk match by the part of it that they hold. The same fifth makes a block
/// one that should have been found.
inline constexpr int truth_block_px = 5;
inline constexpr int minimum_true_pixels = 5;

/// The content of a block between two depths.
struct BlockContent {
  int pixels = 0;           ///< of 25
  int object = 0;           ///< that most of them belong to; 0 if unknown
  double mean_depth_m = 0;  ///< of these pixels
  bool holds() const { return pixels >= minimum_true_pixels; }
};

/// Which pixels of a block count.
enum class Surfaces {
  any,
  obstacles,        ///< neither the ground nor nothing (objects 1 and 0)
  shared_obstacles  ///< of those the ones that both eyes see
};

/// Of the block whose top left pixel is (column_px, row_px), inside the image.
BlockContent content_between(const TrueImages& truth, int column_px, int row_px, DepthInterval depths,
                             Surfaces surfaces);

/// A depth that is looked at: that of the whole disparity nearest to the requested depth.
struct DetectionDepth {
  int disparity_px = 0;
  double depth_m = 0;
  DepthInterval one_pixel;
  DepthInterval half_pixel;  ///< depths whose disparities round to this one, which it can match
};

/// As PushbroomStereo computes it, which refuses depths whose disparity lies within a pixel of infinity.
DetectionDepth detection_depth(const StereoRig& rig, double asked_m);

/// Where obstacles are to be found: blocks of 5x5 px side by side, down to the last row looked at, and only
/// columns whose partner at the disparity lies in the right image. The same for every algorithm.
struct DetectionGrid {
  /// `last_row_px`: as PushbroomConfig's.
  DetectionGrid(const StereoRig& rig, std::vector<double> depths_m, int last_row_px);

  std::vector<DetectionDepth> depths;
  int columns = 0;  ///< of blocks
  int rows = 0;

  int first_column(std::size_t depth) const;
  int block_count() const { return columns * rows; }
  /// Of the block that the hit's centre lies in; -1 if that is not in the grid.
  int block_of(const StereoHit& hit) const;
  /// The depth looked at that is nearest to the hit's.
  std::size_t depth_of(const StereoHit& hit) const;
  /// A block's place among the blocks of all depths.
  std::size_t place(std::size_t depth, int block) const {
    return depth * static_cast<std::size_t>(block_count()) + static_cast<std::size_t>(block);
  }
  /// Of every place, whether one of the hits lies there.
  std::vector<bool> places_hit(const std::vector<StereoHit>& hits) const;
};

/// A block that holds an obstacle at a depth looked at, where both eyes see it.
struct ExpectedBlock {
  int block = 0;  ///< row * columns + column
  std::size_t depth = 0;
  int object = 0;
  double mean_depth_m = 0;
};

/// All expected blocks of one frame, for each depth looked at: within `tolerance_m` to either side of it, or,
/// without a tolerance, in its one-pixel interval.
std::vector<ExpectedBlock> expected_blocks(const TrueImages& truth, const DetectionGrid& grid,
                                           std::optional<double> tolerance_m = {});

/// A hit on the grid's block at a depth looked at: as a detector would put it.
StereoHit hit_on_block(const StereoRig& rig, const DetectionDepth& depth, int column_px, int row_px);

/// The hits of a detector that knows the truth: a hit on every block of the grid that holds any surface,
/// ground too, within one pixel of a depth looked at.
std::vector<StereoHit> true_depth_hits(const TrueImages& truth, const DetectionGrid& grid,
                                       const StereoRig& rig);

/// Hits on `count` random blocks of the grid, at the first depth looked at: the paper's measure of how little
/// a score means (Barry & Tedrake 2015, evaluations 2 and 3).
std::vector<StereoHit> random_hits(std::size_t count, const DetectionGrid& grid, const StereoRig& rig,
                                   std::mt19937_64& generator);

}  // namespace understory
