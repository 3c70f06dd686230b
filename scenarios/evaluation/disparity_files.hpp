#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

#include "perception/stereo_rig.hpp"

/// Disparities that another program has computed of a recording's pairs.
namespace understory {

/// An algorithm's name and its folder, which has a file for each pair, named as the left image: PFM, or PNG
/// of 16 bits in 1/256 px (KITTI's). For several recordings it has a folder for each, of the same name.
struct DisparityFolder {
  std::string name;
  std::filesystem::path folder;
};

/// Whether an algorithm may have this name, which becomes a folder's: without '/', no '.' first.
bool names_a_folder(const std::string& name);

/// Reads "NAME=FOLDER". Throws ScenarioError if it is not that.
DisparityFolder disparity_folder_of(const std::string& argument);

/// The disparities of the pair of this time: CV_32FC1, u_left - u_right in px of the rectified left image, 0
/// where unknown (infinite in PFM, 0 in PNG). Throws ScenarioError, one line that names the file, where there
/// is none, or none of the rig's size, or a disparity is negative.
cv::Mat read_disparity(const std::filesystem::path& folder, std::int64_t t_ns, const StereoRig& rig);

/// A file of disparities, PFM or PNG of 16 bits in 1/256 px by its name: CV_32FC1, px; unknown (infinite in
/// PFM, 0 in PNG) is infinite or NaN. Throws ScenarioError, one line that names the file.
cv::Mat read_disparity_file(const std::filesystem::path& file);

/// A PFM of one channel: CV_32FC1, top row first. `name` stands for the file in messages. Throws InputError.
cv::Mat parse_pfm(const std::string& bytes, const std::string& name);

/// The depth that disparities stand for: CV_32FC1, m, 0 where unknown or beyond infinity.
cv::Mat depth_of_disparity(const cv::Mat& disparity_px, const StereoRig& rig);

/// How far disparities lie from true ones, over the pixels that have a true depth.
struct DisparityErrors {
  std::int64_t true_pixels = 0;                  ///< that have a true depth
  std::int64_t matched = 0;                      ///< of these, that have a disparity
  std::int64_t bad_1 = 0, bad_2 = 0, bad_4 = 0;  ///< of the matched, off by more than so many px
  double sum_px = 0;                             ///< of the matched pixels' errors

  /// `depth_m`: as depth_of_disparity gives it; `true_depth_mm`: CV_16UC1, 0 where unknown.
  void count(const cv::Mat& depth_m, const cv::Mat& true_depth_mm, const StereoRig& rig);
  void add(const DisparityErrors& other);
};

}  // namespace understory
