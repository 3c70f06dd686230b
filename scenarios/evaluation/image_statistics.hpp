#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/evaluation/image_pairs.hpp"
#include "scenarios/report/table.hpp"

namespace understory {

/// What a block matcher depends on, of the pairs of one source. Blocks are 5x5 pixels side by side; edges are
/// the detector's own (the Laplacian of bytes, negative values 0). NaN: cannot be known of these pairs.
struct ImageStatistics {
  std::string name;
  int pairs = 0, width_px = 0, height_px = 0;  ///< of the first pair
  /// Power falls with spatial frequency to the power of this, averaged over directions and images, from 0.02
  /// to 0.3 cycles a pixel (Hann window). Natural images: 1.88 with a standard deviation of 0.42 (van der
  /// Schaaf & van Hateren 1996, Vision Research 36, 2759).
  double power_slope = 0;
  double edges_over_860 = 0;  ///< share of blocks whose edge sum is over the paper's threshold
  double median_edge_sum = 0;
  double along_gray = 0,
         across_gray = 0;  ///< mean step to the next pixel, along the epipolar line and across
  /// Standard deviation in gray levels, of the flattest tenth of the left images' unclipped blocks by the
  /// mask of Immerkaer 1996 (Computer Vision and Image Understanding 64, 300), which no plane and no edge
  /// along an axis answers.
  double noise_gray = 0;
  /// The same from the difference of the two images where they truly match, by the flattest tenth of these
  /// blocks, divided by the square root of two.
  double pair_noise_gray = 0;
  double true_sad = 0, chance_sad = 0;      ///< median over blocks: at the true disparity, at one by chance
  double true_score = 0, chance_score = 0;  ///< SAD over both edge sums, of blocks over 860 in both
  double confused = 0;  ///< share of these chance matches whose score passes the paper's limit of 54/333
  double mean_gray = 0, dark_gray = 0, bright_gray = 0;  ///< mean, 5th and 95th percentile of the left images
  double clipped = 0;                                    ///< share of pixels at 0 or 255

  std::vector<double> frequency, power;  ///< cycles a pixel; mean power there, of 1 at the first
  std::vector<double> edge_sums;         ///< every hundredth quantile, 0 to 100
};

/// Throws ScenarioError where there is no pair, or one is under 32 pixels wide or high.
ImageStatistics image_statistics(const std::string& name, const std::vector<ImagePair>& pairs);

/// One row a source.
Table image_table(const std::vector<ImageStatistics>& all);

/// The table, the spectra and the distributions of edge sums on a page; `data_root` holds the page's files.
std::string image_page(const std::vector<ImageStatistics>& all, const std::filesystem::path& data_root);

}  // namespace understory
