#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace understory {

/// Every number and every rule of the detector. Defaults are the paper's rule as the original's public code
/// had it (Barry & Tedrake 2015); each rule is a switch of its own.
struct PushbroomConfig {
  std::vector<double> depths_m;  ///< to look at; empty: the rig's own detection depth. 0.1 .. 1000
  std::vector<double> depths_minimum_edge_sum;  ///< minimum_edge_sum of each depth; empty: one for all
  std::vector<double> depths_score_limit;       ///< score_limit of each depth; empty: one for all
  /// Whole disparities to look at, stated by hand as the original's configuration files do ([2],
  /// docs/sources.md), in place of those nearest to depths_m; empty: these. -8192 .. 8192
  std::vector<int> disparities_px;
  /// Whole disparity of the infinitely distant, stated by hand; none: the calibration's, rounded.
  /// -8192 .. 8192
  std::optional<int> infinity_px;
  int threads = 1;           ///< 1 .. 64; hits do not depend on it
  int stride_px = 5;         ///< from block to block, both ways; 1 .. 100; 5 sets the 5x5 blocks side by side
  bool every_pixel = false;  ///< dense: a window at every pixel, of each 5x5 cell of windows the best counts
  /// Top edge of the lowest row of blocks in an image of 240 rows, in proportion in others; 0 .. 240. Rows
  /// below see the ground. The original's lastValidPixelRow, 205, is the end of its lowest blocks.
  int last_row_px = 200;
  /// Columns that no block touches at the end of those compared, 0 .. 100. The original's loop over columns
  /// leaves out a last block that ends with the image.
  int right_margin_px = 1;
  int minimum_edge_sum = 860;         ///< Laplacian sum asked of each image's block by itself; 0 .. 6375
  double score_limit = 54.0 / 333.0;  ///< hit if S = SAD / (both edge sums) is below; exact to 1/333000

  bool horizontal_invariance = true;              ///< reject texture that also matches near infinity
  int invariance_columns_px = 3;                  ///< searched to each side of infinity
  int invariance_rows_px = 8;                     ///< searched up and down
  int invariance_row_step_px = 2;                 ///< from one row searched to the next
  double invariance_score_limit = 108.0 / 333.0;  ///< twice the score limit: 0.324

  bool uniqueness = false;        ///< the disparity must stand out along the row
  double uniqueness_ratio = 2.0;  ///< no other disparity within this many times its SAD
  double uniqueness_minimum_depth_m =
      1.5;  ///< range searched: infinity to here (the paper ignores nearer points)

  /// Puts a hit at the vertex of the parabola through the SADs of its disparity and the two beside it, at
  /// most half a pixel away, where its own is the minimum of the three.
  bool subpixel = false;

  bool isolation = false;            ///< a hit needs company in its own frame
  int isolation_minimum_points = 3;  ///< itself included (the original's avoidance)
  double isolation_radius_m = 1.0;   ///< within which its company lies
};

/// The paper's rule as the original's code has it: its hits, their order and their scores, wherever the
/// original stays inside the images. Hits lie half a pixel up and left of its points.
PushbroomConfig original_pushbroom();
/// Uniqueness instead of the invariance filter, gentler thresholds, 3 points within 1 m: on rendered forests
/// its precision is 0.94 where the paper's thresholds give 0.37 (computed with one prototype;
/// docs/benchmarks.md).
PushbroomConfig robust_pushbroom();
/// The robust rule with the numbers tuned for a rig of models/rigs by its name, `long` or `paper`: most
/// recall at a precision of 0.985 (docs/tuning.md), at the depths that serve flights best (docs/thesis.md).
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
  int window_px = 5;            ///< odd, 5 .. 51
  int min_disparity_px = 2;     ///< searched from here
  int disparities = 112;        ///< multiple of 16
  int texture_threshold = 427;  ///< windows with less texture have no disparity
  int uniqueness_percent = 18;  ///< by which the best match must beat the second
  int prefilter_size_px = 105;  ///< odd, 5 .. 255; without effect on OpenCV's default x-Sobel prefilter
  int prefilter_cap = 61;       ///< 1 .. 63
  int speckle_window_px = 59;   ///< smaller patches are dropped
  int speckle_range = 30;       ///< sixteenths of a pixel between neighbours of a patch
};

/// How many paths StereoSGBM gathers costs along. Three is OpenCV's fast way, five its default.
enum class SgbmPaths { three, five, eight };
inline constexpr std::array<std::pair<std::string_view, SgbmPaths>, 3> sgbm_paths_names{
    {{"three", SgbmPaths::three}, {"five", SgbmPaths::five}, {"eight", SgbmPaths::eight}}};

/// OpenCV's StereoSGBM (Hirschmueller 2008). The paper flew none: the search is StereoBM's above, the rest
/// the values that OpenCV's documentation of cv::StereoSGBM and its sample stereo_match.cpp suggest.
struct StereoSgbmConfig {
  int window_px = 5;            ///< odd, 1 .. 11 (documentation: 3 .. 11)
  int min_disparity_px = 2;     ///< searched from here
  int disparities = 112;        ///< multiple of 16
  int smoothness_1 = 8;         ///< P1 in windows' areas: a step of one pixel costs so much (sample)
  int smoothness_2 = 32;        ///< P2 likewise: of more pixels; more than smoothness_1
  int uniqueness_percent = 10;  ///< documentation: 5 .. 15
  int prefilter_cap = 63;       ///< sample
  int left_right_px = 1;        ///< matched back from the right, at most so far off (sample); -1: not asked
  int speckle_window_px = 100;  ///< documentation: 50 .. 200
  int speckle_range_px = 2;     ///< documentation: 1 or 2
  SgbmPaths paths = SgbmPaths::five;  ///< directions that costs are summed along
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

/// What of a depth image becomes hits.
struct FullStereoCrop {
  double minimum_depth_m = 1.5;  ///< 0.1 .. 1000 (Barry & Tedrake 2015 ignore nearer points)
  /// 0.1 .. 1000. At 15 m a pixel of disparity is 3.5 m of the paper's rig and 1.7 m of the long one: what
  /// lies farther is seen too coarsely to be placed (our choice).
  double maximum_depth_m = 15;
  /// 0.1 .. 1000; hits farther below the optical axis are dropped: beneath the pushbroom's last row, at its
  /// depth, the ground begins (2.6 m below on the long rig, 2.8 m on the paper's), and farther out that row
  /// would see it.
  double maximum_below_m = 2.7;
  int cell_px = 5;                  ///< one hit for each cell of this size, the pushbroom's block
  int minimum_pixels_per_cell = 5;  ///< matched pixels inside the depths that make a hit (our choice)
  int last_row_px = 205;            ///< top edge of the lowest row of cells, as PushbroomConfig's
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

/// How long, how many and whom the map remembers.
struct LocalMapConfig {
  double max_age_s = 4.0;  ///< points older than this go (the original remembered 2 to 4 s)
  /// A point goes once it lies this far behind the aircraft along its heading. Larger than the half span
  /// (0.43 m) and what a turn swings the wing tips by, so that nothing still beside a wing is lost.
  double passed_m = 2.0;
  int max_points = 5000;   ///< beyond this the oldest go first
  double voxel_m = 0.10;   ///< a hit in the voxel of a remembered point refreshes it; 0 keeps every hit
  int min_neighbours = 2;  ///< other points a trusted point needs (with itself 3, the original's avoidance)
  double neighbour_radius_m = 1.0;    ///< within this distance
  bool seen_again = false;            ///< a trusted point also needs support from a second frame
  double seen_again_radius_m = 0.35;  ///< a point of another frame this near (or itself seen twice)
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

/// How sightings at two depths become one displacement.
struct ResightingsConfig {
  bool enabled = false;          ///< whether obstacles seen at two depths measure the ground velocity
  std::vector<double> depths_m;  ///< that the detector looks at; the composition knows them, no key says them
  /// Level distance from a cluster's centre within which hits of one depth join it. While a trunk crosses the
  /// depth interval of a pixel (1.6 m at 10 m), its places smear over as much in the odometry frame, and by
  /// what a wind that is not yet known carries meanwhile.
  double cluster_m = 2.0;
  int minimum_hits = 8;    ///< a cluster of fewer is left alone
  double settle_s = 0.04;  ///< a nearer cluster without a hit for as long is complete
  /// Level distance between the two places of one obstacle, at most: an unknown wind of 5 m/s over the half
  /// second between 10 and 5 m.
  double match_m = 2.5;
  double rival = 1.5;     ///< any other far cluster must be this many times as distant
  double oldest_s = 0.9;  ///< between the two sightings, at most
  /// Of the discrepancy, along the line of sight: what remains of a pixel's depth interval once its crossing
  /// is averaged, and of where a trunk's face lies.
  double along_sigma_m = 0.25;
  double across_sigma_m = 0.10;  ///< and across it: blocks of 5 pixels at 10 m are 0.13 m
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
