#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace understory {

/// The parameters of the detector. The defaults are those of the original's public code (Barry & Tedrake
/// 2015); each test is a switch of its own.
struct PushbroomConfig {
  /// Depths at which the detector looks for obstacles; empty: the rig's detection depth alone. The preset
  /// `tuned` names two for the rig `paper`.
  std::vector<double> depths_m;
  /// The minimum_edge_sum of each depth, in the order of depths_m; empty: all depths share one.
  std::vector<double> depths_minimum_edge_sum;
  /// The score_limit of each depth, in the order of depths_m; empty: all depths share one.
  std::vector<double> depths_score_limit;
  /// Whole disparities to look at, in place of depths_m, as the original's configuration files state them
  /// (docs/sources.md [2]); empty: those nearest to depths_m.
  std::vector<int> disparities_px;
  /// Whole disparity of an infinitely distant point; none: the calibration's, rounded.
  std::optional<int> infinity_px;
  int threads = 1;           ///< threads that search one pair; the detections do not depend on it
  int stride_px = 5;         ///< distance between neighbouring blocks along rows and columns; 5: side by side
  bool every_pixel = false;  ///< searches a block at every pixel and keeps the best of each 5x5 pixels
  /// Top edge of the lowest row of blocks, for an image of 240 rows; it scales with the image's height. The
  /// ground lies below. The original's lastValidPixelRow, 205, is the end of its lowest blocks.
  int last_row_px = 200;
  /// Columns at the right end of the compared area that no block touches. The original's loop over columns
  /// leaves out a last block that ends with the image.
  int right_margin_px = 1;
  int minimum_edge_sum = 860;  ///< smallest sum of the Laplacian over a block, in each image
  /// A block matches where S = SAD / (sum of both blocks' Laplacians) is below this; exact to 1/333000.
  double score_limit = 54.0 / 333.0;

  bool horizontal_invariance = true;  ///< rejects a block that also matches near infinite depth
  int invariance_columns_px = 3;   ///< columns searched on each side of infinite depth by the invariance test
  int invariance_rows_px = 8;      ///< rows searched above and below a block by the invariance test
  int invariance_row_step_px = 2;  ///< distance between the rows searched by the invariance test
  double invariance_score_limit = 108.0 / 333.0;  ///< score below which the invariance test finds a match

  bool uniqueness = false;  ///< rejects a block that matches nearly as well at another disparity of its row
  double uniqueness_ratio = 2.0;  ///< smallest ratio of any other disparity's SAD to that of the match
  /// Nearest depth at which the uniqueness test searches for other matches; it begins at infinity. The paper
  /// ignores nearer points.
  double uniqueness_minimum_depth_m = 1.5;

  /// Places a detection at the vertex of the parabola through the SADs of its disparity and the two
  /// neighbours, at most half a pixel away, where its own SAD is the smallest of the three.
  bool subpixel = false;

  bool isolation = false;            ///< rejects a detection without enough others near it in the same frame
  int isolation_minimum_points = 3;  ///< smallest number of detections near each other, itself included
  double isolation_radius_m = 1.0;   ///< distance within which the isolation test counts detections
};

/// The paper's rule as the original's code has it: its hits, their order and their scores, wherever the
/// original stays inside the images. Hits lie half a pixel up and left of its points.
PushbroomConfig original_pushbroom();
/// Uniqueness instead of the invariance filter, gentler thresholds, 3 points within 1 m: on rendered forests
/// its precision is 0.94 where the paper's thresholds give 0.37 (computed with one prototype;
/// docs/benchmarks.md).
PushbroomConfig robust_pushbroom();
/// The robust rule with the numbers tuned for a rig of models/rigs by its name, `long` or `paper`: most
/// recall at a precision of 0.985 (docs/tuning.md), at the depths that docs/decisions/025 found.
/// Rigs that nobody has tuned for get robust_pushbroom().
PushbroomConfig tuned_pushbroom(std::string_view rig);

enum class PushbroomPreset { robust, tuned, original };  ///< which numbers a pushbroom detector starts from

inline constexpr std::array<std::pair<std::string_view, PushbroomPreset>, 3> pushbroom_preset_names{
    {{"robust", PushbroomPreset::robust},
     {"tuned", PushbroomPreset::tuned},
     {"original", PushbroomPreset::original}}};

/// The numbers that a preset stands for with a rig of this name.
inline PushbroomConfig pushbroom_of(PushbroomPreset preset, std::string_view rig) {
  switch (preset) {
    case PushbroomPreset::tuned:
      return tuned_pushbroom(rig);
    case PushbroomPreset::robust:
      return robust_pushbroom();
    case PushbroomPreset::original:
      break;
  }
  return original_pushbroom();
}

template <typename Visitor>
void visit_fields(Visitor& visit, PushbroomConfig& config) {
  visit("threads", config.threads, 1, 64);
  visit("stride_px", config.stride_px, 1, 100);
  visit("every_pixel", config.every_pixel);
  visit("last_row_px", config.last_row_px, 0, 240);
  visit("right_margin_px", config.right_margin_px, 0, 100);
  visit("minimum_edge_sum", config.minimum_edge_sum, 0, 6375);
  visit("score_limit", config.score_limit, 0.0, 10.0);
  visit("horizontal_invariance", config.horizontal_invariance);
  visit("invariance_columns_px", config.invariance_columns_px, 0, 50);
  visit("invariance_rows_px", config.invariance_rows_px, 0, 50);
  visit("invariance_row_step_px", config.invariance_row_step_px, 1, 50);
  visit("invariance_score_limit", config.invariance_score_limit, 0.0, 10.0);
  visit("uniqueness", config.uniqueness);
  visit("uniqueness_ratio", config.uniqueness_ratio, 1.0, 100.0);
  visit("uniqueness_minimum_depth_m", config.uniqueness_minimum_depth_m, 0.1, 100.0);
  visit("depths_minimum_edge_sum", config.depths_minimum_edge_sum, 0, 6375);
  visit("depths_score_limit", config.depths_score_limit, 0.0, 10.0);
  visit("disparities_px", config.disparities_px, -8192, 8192);
  visit("infinity_px", config.infinity_px, -8192, 8192);
  visit("subpixel", config.subpixel);
  visit("isolation", config.isolation);
  visit("isolation_minimum_points", config.isolation_minimum_points, 1, 1000);
  visit("isolation_radius_m", config.isolation_radius_m, 0.0, 100.0);
}

/// OpenCV's StereoBM with the settings of the paper's evaluation (Barry & Tedrake 2015; public evaluation
/// code). Disparities count from the rig's infinity, so 2 .. 113 px are parallax.
struct StereoBmConfig {
  int window_px = 5;            ///< side of the square that is matched; odd
  int min_disparity_px = 2;     ///< smallest disparity searched, counted from the rig's infinity
  int disparities = 112;        ///< number of disparities searched; a multiple of 16
  int texture_threshold = 427;  ///< a window with less texture gets no disparity (OpenCV's textureThreshold)
  int uniqueness_percent = 18;  ///< margin by which the best match must beat the second best
  int prefilter_size_px = 105;  ///< window of OpenCV's normalising prefilter (not its default)
  int prefilter_cap = 61;       ///< limit of the prefiltered image (OpenCV's preFilterCap)
  int speckle_window_px = 59;   ///< area below which a patch of disparity is removed, in pixels
  int speckle_range = 30;       ///< largest step of disparity within a patch, in sixteenths of a pixel
};

/// How many paths StereoSGBM gathers costs along. Three is OpenCV's fast way, five its default.
enum class SgbmPaths { three, five, eight };
inline constexpr std::array<std::pair<std::string_view, SgbmPaths>, 3> sgbm_paths_names{
    {{"three", SgbmPaths::three}, {"five", SgbmPaths::five}, {"eight", SgbmPaths::eight}}};

/// OpenCV's StereoSGBM (Hirschmueller 2008). The paper flew none: the search is StereoBM's above, the rest
/// the values that OpenCV's documentation of cv::StereoSGBM and its sample stereo_match.cpp suggest.
struct StereoSgbmConfig {
  int window_px = 5;         ///< side of the square that is matched; odd (OpenCV advises 3 to 11)
  int min_disparity_px = 2;  ///< smallest disparity searched, counted from the rig's infinity
  int disparities = 112;     ///< number of disparities searched; a multiple of 16
  int smoothness_1 = 8;      ///< cost of a disparity step of one pixel, times the window's area (OpenCV's P1)
  int smoothness_2 = 32;     ///< cost of a larger step, times the window's area (P2); more than smoothness_1
  int uniqueness_percent = 10;  ///< margin of the best match over the second (OpenCV advises 5 to 15)
  int prefilter_cap = 63;       ///< limit of the prefiltered image (OpenCV's preFilterCap)
  int left_right_px = 1;        ///< left-right consistency: largest difference of disparity; -1: not checked
  int speckle_window_px = 100;  ///< area below which a patch is removed (OpenCV advises 50 to 200)
  int speckle_range_px = 2;     ///< largest step of disparity within a patch (OpenCV advises 1 or 2)
  SgbmPaths paths = SgbmPaths::five;  ///< number of directions along which costs are summed
};

template <typename Visitor>
void visit_fields(Visitor& visit, StereoBmConfig& config) {
  visit("window_px", config.window_px, 5, 51);
  visit("min_disparity_px", config.min_disparity_px, 1, 1000);
  visit("disparities", config.disparities, 16, 1024);
  visit("texture_threshold", config.texture_threshold, 0, 100000);
  visit("uniqueness_percent", config.uniqueness_percent, 0, 100);
  visit("prefilter_size_px", config.prefilter_size_px, 5, 255);
  visit("prefilter_cap", config.prefilter_cap, 1, 63);
  visit("speckle_window_px", config.speckle_window_px, 0, 10000);
  visit("speckle_range", config.speckle_range, 0, 1000);
}

template <typename Visitor>
void visit_fields(Visitor& visit, StereoSgbmConfig& config) {
  visit("window_px", config.window_px, 1, 11);
  visit("min_disparity_px", config.min_disparity_px, 1, 1000);
  visit("disparities", config.disparities, 16, 1024);
  visit("smoothness_1", config.smoothness_1, 0, 1000);
  visit("smoothness_2", config.smoothness_2, 1, 1000);
  visit("uniqueness_percent", config.uniqueness_percent, 0, 100);
  visit("prefilter_cap", config.prefilter_cap, 1, 127);
  visit("left_right_px", config.left_right_px, -1, 100);
  visit("speckle_window_px", config.speckle_window_px, 0, 10000);
  visit("speckle_range_px", config.speckle_range_px, 0, 100);
  visit("paths", config.paths, sgbm_paths_names);
}

/// Which pixels of a depth image become detections.
struct FullStereoCrop {
  double minimum_depth_m = 1.5;  ///< nearest depth that is used (Barry & Tedrake 2015 ignore nearer points)
  /// Farthest depth that is used. At 15 m a pixel of disparity is 3.5 m of depth on the paper's rig and 1.7 m
  /// on the long rig: farther obstacles cannot be placed (our choice).
  double maximum_depth_m = 15;
  /// Distance below the optical axis beyond which detections are dropped, because the ground begins there:
  /// the pushbroom's last row lies 2.6 m (long rig) and 2.8 m (paper's rig) below at its depth.
  double maximum_below_m = 2.7;
  int cell_px = 5;  ///< side of the square that gives at most one detection; the pushbroom's block
  int minimum_pixels_per_cell = 5;  ///< matched pixels within the depths that make a detection (our choice)
  int last_row_px = 205;            ///< top edge of the lowest row of cells, for an image of 240 rows
};

template <typename Visitor>
void visit_fields(Visitor& visit, FullStereoCrop& crop) {
  visit("minimum_depth_m", crop.minimum_depth_m, 0.1, 1000.0);
  visit("maximum_depth_m", crop.maximum_depth_m, 0.1, 1000.0);
  visit("maximum_below_m", crop.maximum_below_m, 0.1, 1000.0);
  visit("cell_px", crop.cell_px, 1, 100);
  visit("minimum_pixels_per_cell", crop.minimum_pixels_per_cell, 1, 10000);
  visit("last_row_px", crop.last_row_px, 0, 240);
}

/// Which points the map keeps, and which of them it trusts.
struct LocalMapConfig {
  double max_age_s = 4.0;  ///< age at which a point is forgotten (the original remembered 2 to 4 s)
  /// Distance behind the aircraft, along its heading, at which a point is forgotten. It is larger than the
  /// half span (0.43 m) and the swing of a wing tip in a turn, so that no point beside a wing is lost.
  double passed_m = 2.0;
  int max_points = 5000;            ///< number of points beyond which the oldest are forgotten
  double voxel_m = 0.10;            ///< side of a voxel; a detection in a point's voxel refreshes it; 0: none
  int min_neighbours = 2;           ///< other points near a point that make it trusted (original: 2)
  double neighbour_radius_m = 1.0;  ///< distance within which a point counts as a neighbour
  bool seen_again = false;          ///< trusts a point only where a second frame saw it, too
  double seen_again_radius_m = 0.35;  ///< distance within which a point of another frame confirms a point
};

template <typename Visitor>
void visit_fields(Visitor& visit, LocalMapConfig& config) {
  visit("max_age_s", config.max_age_s, 0.0, 600.0);
  visit("passed_m", config.passed_m, 0.0, 1000.0);
  visit("max_points", config.max_points, 1, 1000000);
  visit("voxel_m", config.voxel_m, 0.0, 10.0);
  visit("min_neighbours", config.min_neighbours, 0, 1000);
  visit("neighbour_radius_m", config.neighbour_radius_m, 0.01, 100.0);
  visit("seen_again", config.seen_again);
  visit("seen_again_radius_m", config.seen_again_radius_m, 0.0, 100.0);
}

/// How two sightings of an obstacle, at a far and at a near depth, measure the drift of the odometry.
struct ResightingsConfig {
  bool enabled = false;          ///< measures the velocity over ground from obstacles seen at two depths
  std::vector<double> depths_m;  ///< the detector's depths; the autopilot's composition sets them, no key
  /// Level distance from a cluster's centre within which detections of one depth join it. While a trunk
  /// crosses one pixel's depth interval (1.6 m at 10 m), its places smear over as much in the odometry frame.
  double cluster_m = 2.0;
  int minimum_hits = 8;    ///< smallest number of detections that make a cluster usable
  double settle_s = 0.04;  ///< time without a detection after which the near cluster is complete
  /// Largest level distance between the two places of one obstacle: an unknown wind of 5 m/s over the half
  /// second between 10 and 5 m.
  double match_m = 2.5;
  double rival = 1.5;     ///< smallest ratio of distances, second nearest far cluster to nearest
  double oldest_s = 0.9;  ///< longest time between the two sightings
  /// Standard deviation of the measured displacement along the line of sight: what remains of a pixel's depth
  /// interval once its crossing is averaged, and of where a trunk's face lies.
  double along_sigma_m = 0.25;
  double across_sigma_m = 0.10;  ///< standard deviation of the displacement across the line of sight
};

template <typename Visitor>
void visit_fields(Visitor& visit, ResightingsConfig& config) {
  visit("enabled", config.enabled);
  visit("cluster_m", config.cluster_m, 0.05, 10.0);
  visit("minimum_hits", config.minimum_hits, 1, 10000);
  visit("settle_s", config.settle_s, 0.0, 1.0);
  visit("match_m", config.match_m, 0.05, 20.0);
  visit("rival", config.rival, 1.0, 100.0);
  visit("oldest_s", config.oldest_s, 0.05, 10.0);
  visit("along_sigma_m", config.along_sigma_m, 0.001, 10.0);
  visit("across_sigma_m", config.across_sigma_m, 0.001, 10.0);
}

}  // namespace understory
