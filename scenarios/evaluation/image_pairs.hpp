#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace understory {

/// A rectified stereo pair of whatever source.
struct ImagePair {
  std::string name;
  cv::Mat left, right;   ///< CV_8UC1, of one size
  cv::Mat disparity_px;  ///< CV_32FC1, true u_left - u_right of the left image, not finite where unknown; or
                         ///< empty
};

/// The pairs of a folder; of a recording every `every`-th:
/// - a recording in EuRoC's layout, rectified, with disparities where it has true depth; or
/// - left.png and right.png, and disparity.png or disparity.pfm, if there (docs/evaluate.md says what these
///   hold); or
/// - folders of that kind, each with one pair, by name.
/// Throws ScenarioError, one line, where the folder is none of these, or a file cannot be read.
std::vector<ImagePair> read_image_pairs(const std::filesystem::path& folder, int every);

/// Made narrower to this width, by the mean over area; disparities are scaled, and known where the nearest
/// is. A pair that is not wider stays as it is.
ImagePair narrowed(const ImagePair& pair, int width_px);

}  // namespace understory
