#include "perception/perception_config.hpp"

#include "perception/field_visitor.hpp"

namespace understory {

void visit_fields(FieldVisitor& visit, PushbroomConfig& config) {
  visit("threads", config.threads, 1, 64,
        "number of threads that search one stereo pair; it does not change the detections");
  visit("stride_px", config.stride_px, 1, 100,
        "Step from one block to the next along rows and columns. 5: side by side. Steps of 3 and 2 find more "
        "of an obstacle, since a block is more likely to fit it, and take 2 and 4 times as long.");
  visit(
      "cell_px", config.cell_px, 0, 100,
      "Side of the square image cells, each of which gives at most one detection for each depth: the one "
      "with the lowest score, chosen after all tests. For blocks that overlap. 0: all detections are given.");
  visit("last_row_px", config.last_row_px, 0, 240,
        "Top edge of the lowest row of blocks, for an image of 240 rows; it scales with the image's height. "
        "Lower rows show the ground. The original's lastValidPixelRow, 205, is the bottom edge of its lowest "
        "blocks.");
  visit("right_margin_px", config.right_margin_px, 0, 100,
        "Columns at the right end of the compared area that no block touches. The original skips a block "
        "that ends exactly at the image's edge, which is a margin of 1.");
  visit("minimum_edge_sum", config.minimum_edge_sum, 0, 6375,
        "smallest sum of the Laplacian over a block, in each image; blocks with less texture are skipped");
  visit("score_limit", config.score_limit, 0.0, 10.0,
        "A block matches where its score, SAD / (sum of the Laplacian over both blocks), is below this. The "
        "limit is rounded to 1/333000.");
  visit("horizontal_invariance", config.horizontal_invariance,
        "rejects a block that also matches near where an infinitely distant point would lie");
  visit("invariance_columns_px", config.invariance_columns_px, 0, 50,
        "columns that the invariance test searches on each side of an infinitely distant point's column");
  visit("invariance_rows_px", config.invariance_rows_px, 0, 50,
        "rows that the invariance test searches above and below a block");
  visit("invariance_row_step_px", config.invariance_row_step_px, 1, 50,
        "step between the rows that the invariance test searches");
  visit("invariance_score_limit", config.invariance_score_limit, 0.0, 10.0,
        "score below which a block counts as a match in the invariance test");
  visit("uniqueness", config.uniqueness,
        "rejects a block that matches nearly as well at another disparity in the same row");
  visit("uniqueness_ratio", config.uniqueness_ratio, 1.0, 100.0,
        "factor by which the SAD at any disparity more than one pixel away must exceed the match's SAD");
  visit("uniqueness_minimum_depth_m", config.uniqueness_minimum_depth_m, 0.1, 100.0,
        "The uniqueness test searches for other matches from infinity to this depth. The paper ignores "
        "nearer points.");
  visit("depths_minimum_edge_sum", config.depths_minimum_edge_sum, 0, 6375,
        "One minimum_edge_sum for each depth, in the order of depths_m; empty: minimum_edge_sum holds for "
        "all.");
  visit("depths_score_limit", config.depths_score_limit, 0.0, 10.0,
        "One score_limit for each depth, in the order of depths_m; empty: score_limit holds for all.");
  visit(
      "disparities_px", config.disparities_px, -8192, 8192,
      "Whole-pixel disparities u_right - u_left to search, as the original's configuration files state them "
      "(-105 for the paper's rig); empty: those nearest to depths_m. | docs/sources.md [2]");
  visit("infinity_px", config.infinity_px, -8192, 8192,
        "Whole-pixel disparity u_right - u_left of an infinitely distant point in the invariance and "
        "uniqueness tests (-95 for the paper's rig); ~: the calibration's, rounded.");
  visit("subpixel", config.subpixel,
        "Refines a disparity to the vertex of the parabola through the SADs at the match and one pixel to "
        "either side. It moves by half a pixel at most, and only if the match's SAD is the smallest.");
  visit("isolation", config.isolation,
        "rejects a detection that has too few others near it in the same frame");
  visit("isolation_minimum_points", config.isolation_minimum_points, 1, 1000,
        "detections, itself included, that a detection needs within isolation_radius_m to be kept");
  visit("isolation_radius_m", config.isolation_radius_m, 0.0, 100.0,
        "distance within which the isolation test counts other detections");
}

void visit_fields(FieldVisitor& visit, StereoBmConfig& config) {
  visit("window_px", config.window_px, 5, 51, "side of the square matching window; odd");
  visit("min_disparity_px", config.min_disparity_px, 1, 1000,
        "smallest disparity searched, relative to that of an infinitely distant point");
  visit("disparities", config.disparities, 16, 1024, "number of disparities searched; a multiple of 16");
  visit("texture_threshold", config.texture_threshold, 0, 100000,
        "a window with less texture gets no disparity (OpenCV's textureThreshold)");
  visit("uniqueness_percent", config.uniqueness_percent, 0, 100,
        "percentage by which any other match must cost more than the best (OpenCV's uniquenessRatio)");
  visit("prefilter_size_px", config.prefilter_size_px, 5, 255,
        "no effect: window of OpenCV's normalising prefilter, but its x-Sobel prefilter is in use");
  visit("prefilter_cap", config.prefilter_cap, 1, 63,
        "limit to which the prefiltered image is clipped (OpenCV's preFilterCap)");
  visit("speckle_window_px", config.speckle_window_px, 0, 10000,
        "connected patches of disparity with up to this many pixels are removed; 0: none are");
  visit("speckle_range", config.speckle_range, 0, 1000,
        "largest disparity step between neighbours within a patch, in sixteenths of a pixel");
}

void visit_fields(FieldVisitor& visit, StereoSgbmConfig& config) {
  visit("window_px", config.window_px, 1, 11,
        "side of the square matching window; odd (OpenCV advises 3 to 11)");
  visit("min_disparity_px", config.min_disparity_px, 1, 1000,
        "smallest disparity searched, relative to that of an infinitely distant point");
  visit("disparities", config.disparities, 16, 1024, "number of disparities searched; a multiple of 16");
  visit("smoothness_1", config.smoothness_1, 0, 1000,
        "penalty for a disparity step of one pixel; OpenCV's P1 is this times the window's area");
  visit("smoothness_2", config.smoothness_2, 1, 1000,
        "penalty for a larger step, more than smoothness_1; OpenCV's P2 is this times the window's area");
  visit("uniqueness_percent", config.uniqueness_percent, 0, 100,
        "percentage by which the best match must cost less than any other (OpenCV advises 5 to 15)");
  visit("prefilter_cap", config.prefilter_cap, 1, 127,
        "limit to which the prefiltered image is clipped (OpenCV's preFilterCap)");
  visit("left_right_px", config.left_right_px, -1, 100,
        "largest difference between left-to-right and right-to-left disparity; -1 and 0 act as 1");
  visit("speckle_window_px", config.speckle_window_px, 0, 10000,
        "connected patches with up to this many pixels are removed (OpenCV advises 50 to 200)");
  visit("speckle_range_px", config.speckle_range_px, 0, 100,
        "largest disparity step between neighbours within a patch (OpenCV advises 1 or 2)");
  visit("paths", config.paths, sgbm_paths_names,
        "number of directions along which matching costs are summed");
}

void visit_fields(FieldVisitor& visit, FullStereoCrop& crop) {
  visit("minimum_depth_m", crop.minimum_depth_m, 0.1, 1000.0,
        "smallest depth of a detection (Barry & Tedrake 2015 ignore nearer points) | Barry & Tedrake 2015");
  visit("maximum_depth_m", crop.maximum_depth_m, 0.1, 1000.0,
        "Largest depth of a detection. At 15 m a pixel of disparity spans 3.5 m of depth on the paper's rig "
        "and 1.7 m on the long rig: farther obstacles cannot be placed (our choice).");
  visit("maximum_below_m", crop.maximum_below_m, 0.1, 1000.0,
        "Detections farther below the optical axis than this are dropped, because they show the ground. At "
        "its detection depth the pushbroom's last row lies 2.7 m (long rig) and 2.8 m (paper's rig) below "
        "the axis.");
  visit("cell_px", crop.cell_px, 1, 100,
        "side of the square image cells, each of which gives at most one detection; as large as the "
        "pushbroom detector's block");
  visit(
      "minimum_pixels_per_cell", crop.minimum_pixels_per_cell, 1, 10000,
      "number of matched pixels within the depth limits that a cell needs to give a detection (our choice)");
  visit("last_row_px", crop.last_row_px, 0, 240,
        "lowest image row that may be the top edge of a cell, for an image of 240 rows; scaled to other "
        "heights");
}

void visit_fields(FieldVisitor& visit, LocalMapConfig& config) {
  visit("max_age_s", config.max_age_s, 0.0, 600.0,
        "time since its last detection beyond which a map point is deleted (the original: 2 to 4 s)");
  visit("passed_m", config.passed_m, 0.0, 1000.0,
        "The map deletes a point that lies farther behind the aircraft than this, along the heading. The "
        "distance exceeds the half span (0.43 m) and the swing of a wing tip in a turn, so that no point "
        "beside a wing is deleted.");
  visit("max_points", config.max_points, 1, 1000000,
        "largest number of points in the map; beyond it the oldest are deleted");
  visit("voxel_m", config.voxel_m, 0.0, 10.0,
        "side of the map's voxels; a detection in a voxel that already holds a point replaces that point; 0: "
        "every detection adds a point");
  visit("min_neighbours", config.min_neighbours, 0, 1000,
        "number of neighbours that a map point needs for the planner to use it (original: 2)");
  visit("neighbour_radius_m", config.neighbour_radius_m, 0.01, 100.0,
        "distance within which two map points count as neighbours of each other");
  visit("seen_again", config.seen_again,
        "the planner uses a map point only after a second frame has detected it, or another point within "
        "seen_again_radius_m");
  visit("seen_again_radius_m", config.seen_again_radius_m, 0.0, 100.0,
        "distance within which a map point from another frame confirms a map point, with seen_again");
}

void visit_fields(FieldVisitor& visit, ResightingsConfig& config) {
  visit("enabled", config.enabled, "measures the velocity over ground from obstacles seen at two depths");
  visit("cluster_m", config.cluster_m, 0.05, 10.0,
        "Horizontal distance from a cluster's centre within which detections at the same depth join the "
        "cluster. While the aircraft flies through the depth interval of a pixel (1.6 m at 10 m), the "
        "measured positions of a trunk spread over the same length.");
  visit("minimum_hits", config.minimum_hits, 1, 10000,
        "smallest number of detections in a cluster that is used");
  visit("settle_s", config.settle_s, 0.0, 1.0,
        "time without a new detection after which a cluster is complete");
  visit("match_m", config.match_m, 0.05, 20.0,
        "Largest horizontal distance between the far and the near cluster of one obstacle: the drift in an "
        "unknown wind of 5 m/s during the 0.5 s of flight from 10 to 5 m of depth.");
  visit("rival", config.rival, 1.0, 100.0,
        "a near cluster is matched only if the second nearest far cluster is at least this many times as far "
        "away as the nearest");
  visit("oldest_s", config.oldest_s, 0.05, 10.0,
        "longest time between the far and the near sighting of one obstacle");
  visit("along_sigma_m", config.along_sigma_m, 0.001, 10.0,
        "Standard deviation of the measured displacement along the line of sight. It covers the depth error "
        "of a pixel that averaging leaves, and the unknown position of the trunk's surface.");
  visit("across_sigma_m", config.across_sigma_m, 0.001, 10.0,
        "standard deviation of the measured displacement across the line of sight");
}

}  // namespace understory
