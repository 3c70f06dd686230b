#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace understory {

class FieldVisitor;

/// The parameters of the detector. The defaults are those of the original's public code (Barry & Tedrake
/// 2015); each test is a switch of its own.
struct PushbroomConfig {
  std::vector<double> depths_m;
  std::vector<double> depths_minimum_edge_sum;
  std::vector<double> depths_score_limit;
  std::vector<int> disparities_px;
  std::optional<int> infinity_px;
  int threads = 1;
  int stride_px = 5;
  int cell_px = 0;
  int last_row_px = 200;
  int right_margin_px = 1;
  int minimum_edge_sum = 860;
  double score_limit = 54.0 / 333.0;

  bool horizontal_invariance = true;
  int invariance_columns_px = 3;
  int invariance_rows_px = 8;
  int invariance_row_step_px = 2;
  double invariance_score_limit = 108.0 / 333.0;

  bool uniqueness = false;
  double uniqueness_ratio = 2.0;
  double uniqueness_minimum_depth_m = 1.5;

  bool subpixel = false;

  bool isolation = false;
  int isolation_minimum_points = 3;
  double isolation_radius_m = 1.0;
};

/// The paper's rule as in the original's code: the same hits, order and scores, where that code stays inside
/// the images. Hits lie half a pixel up and left of its points.
PushbroomConfig original_pushbroom();
/// Uniqueness instead of the invariance filter, gentler thresholds, 3 points within 1 m: on rendered forests
/// its precision is 0.94 where the paper's thresholds give 0.37 (computed with one prototype;
/// docs/benchmarks.md).
PushbroomConfig robust_pushbroom();
/// The robust rule with the numbers tuned for a rig of models/rigs by its name, `long` or `paper`: most
/// recall at a precision of 0.985 (docs/tuning.md), at the depths that docs/decisions/025 found.
/// Rigs that nobody has tuned for get robust_pushbroom().
PushbroomConfig tuned_pushbroom(std::string_view rig);

/// Blocks that overlap, at most one detection in 5x5 px, and the numbers found for that on recordings of
/// woods, seen through a lens (docs/woods.md), for the rigs `long` and `paper`. Other rigs get
/// tuned_pushbroom().
PushbroomConfig woods_pushbroom(std::string_view rig);

/// which numbers a pushbroom detector starts from
enum class PushbroomPreset { robust, tuned, woods, original };

inline constexpr std::array<std::pair<std::string_view, PushbroomPreset>, 4> pushbroom_preset_names{
    {{"robust", PushbroomPreset::robust},
     {"tuned", PushbroomPreset::tuned},
     {"woods", PushbroomPreset::woods},
     {"original", PushbroomPreset::original}}};

/// The numbers that a preset stands for with a rig of this name.
inline PushbroomConfig pushbroom_of(PushbroomPreset preset, std::string_view rig) {
  switch (preset) {
    case PushbroomPreset::tuned:
      return tuned_pushbroom(rig);
    case PushbroomPreset::robust:
      return robust_pushbroom();
    case PushbroomPreset::woods:
      return woods_pushbroom(rig);
    case PushbroomPreset::original:
      break;
  }
  return original_pushbroom();
}

void visit_fields(FieldVisitor& visit, PushbroomConfig& config);

/// OpenCV's StereoBM with the settings of the paper's evaluation (Barry & Tedrake 2015; public evaluation
/// code). Disparities count from the rig's infinity, so 2 .. 113 px are parallax.
struct StereoBmConfig {
  int window_px = 5;
  int min_disparity_px = 2;
  int disparities = 112;
  int texture_threshold = 427;
  int uniqueness_percent = 18;
  int prefilter_size_px = 105;
  int prefilter_cap = 61;
  int speckle_window_px = 59;
  int speckle_range = 30;
};

/// How many paths StereoSGBM gathers costs along. Three is OpenCV's fast way, five its default.
enum class SgbmPaths { three, five, eight };
inline constexpr std::array<std::pair<std::string_view, SgbmPaths>, 3> sgbm_paths_names{
    {{"three", SgbmPaths::three}, {"five", SgbmPaths::five}, {"eight", SgbmPaths::eight}}};

/// OpenCV's StereoSGBM (Hirschmueller 2008). Not in the paper: the search range is StereoBM's above, the rest
/// the values that OpenCV's documentation of cv::StereoSGBM and its sample stereo_match.cpp suggest.
struct StereoSgbmConfig {
  int window_px = 5;
  int min_disparity_px = 2;
  int disparities = 112;
  int smoothness_1 = 8;
  int smoothness_2 = 32;
  int uniqueness_percent = 10;
  int prefilter_cap = 63;
  int left_right_px = 1;
  int speckle_window_px = 100;
  int speckle_range_px = 2;
  SgbmPaths paths = SgbmPaths::five;
};

void visit_fields(FieldVisitor& visit, StereoBmConfig& config);

void visit_fields(FieldVisitor& visit, StereoSgbmConfig& config);

/// Which pixels of a depth image become detections.
struct FullStereoCrop {
  double minimum_depth_m = 1.5;
  double maximum_depth_m = 15;
  double maximum_below_m = 2.7;
  int cell_px = 5;
  int minimum_pixels_per_cell = 5;
  int last_row_px = 205;
};

void visit_fields(FieldVisitor& visit, FullStereoCrop& crop);

/// Which points the map keeps, and which of them it trusts.
struct LocalMapConfig {
  double max_age_s = 4.0;
  double passed_m = 2.0;
  int max_points = 50'000;
  double voxel_m = 0.10;
  int min_neighbours = 2;
  double neighbour_radius_m = 1.0;
  bool seen_again = false;
  double seen_again_radius_m = 0.35;
};

void visit_fields(FieldVisitor& visit, LocalMapConfig& config);

/// How two sightings of an obstacle, at a far and at a near depth, measure the drift of the odometry.
struct ResightingsConfig {
  bool enabled = false;
  std::vector<double> depths_m;  ///< the detector's depths; not a key, set by autopilot_config_of()
  double cluster_m = 2.0;
  int minimum_hits = 8;
  double settle_s = 0.04;
  double match_m = 2.5;
  double rival = 1.5;
  double oldest_s = 0.9;
  double along_sigma_m = 0.25;
  double across_sigma_m = 0.10;
};

void visit_fields(FieldVisitor& visit, ResightingsConfig& config);

}  // namespace understory
