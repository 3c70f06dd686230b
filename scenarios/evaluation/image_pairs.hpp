#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "perception/stereo_rig.hpp"

namespace understory {

/// A rectified stereo pair of whatever source.
struct ImagePair {
  std::string name;
  cv::Mat left, right;   ///< CV_8UC1, of one size
  cv::Mat disparity_px;  ///< CV_32FC1, true u_left - u_right of the left image, not finite where unknown; or
                         ///< empty
  std::optional<StereoRig> rig = {};  ///< where its calibration is known
};

/// The pairs of a folder; of a recording every `every`-th:
/// - a recording in EuRoC's layout, rectified, with disparities where it has true depth; or
/// - left.png and right.png, and disparity.png or disparity.pfm, if there (docs/evaluate.md says what these
///   hold); or im0.png and im1.png, disp0GT.pfm or disp0.pfm, and calib.txt as Middlebury and ETH3D have them
///   (ETH3D's disparities lie in the folder of the same name in FOLDER_gt); or
/// - folders of that kind, each with one pair, by name; or
/// - KITTI's stereo benchmark of 2012 or 2015: the folder that holds image_0, image_1, disp_occ and calib, or
///   image_2, image_3, disp_occ_0 and calib_cam_to_cam, or the folder above it. Colour becomes gray.
/// Throws ScenarioError, one line, where the folder is none of these, or a file cannot be read.
std::vector<ImagePair> read_image_pairs(const std::filesystem::path& folder, int every);

/// Made narrower to this width, by the mean over area; disparities are scaled, and known where the nearest
/// is. A pair that is not wider stays as it is.
ImagePair narrowed(const ImagePair& pair, int width_px);

}  // namespace understory
