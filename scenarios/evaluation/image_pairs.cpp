#include "scenarios/evaluation/image_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/image_file.hpp"
#include "perception/io/image_sequence.hpp"
#include "scenarios/config/bad_input.hpp"
#include "scenarios/evaluation/disparity_files.hpp"
#include "scenarios/evaluation/evaluation_recording.hpp"
#include "scenarios/output/errors.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

cv::Mat disparity_of(const TrueImages& truth, const StereoRig& rig) {
  if (truth.depth_mm.empty()) return {};
  cv::Mat disparity(truth.depth_mm.size(), CV_32FC1);
  for (int row = 0; row < disparity.rows; ++row)
    for (int column = 0; column < disparity.cols; ++column) {
      const std::uint16_t depth_mm = truth.depth_mm.at<std::uint16_t>(row, column);
      disparity.at<float>(row, column) = depth_mm == 0
                                             ? std::numeric_limits<float>::quiet_NaN()
                                             : static_cast<float>(rig.disparity_px(1e-3 * depth_mm));
    }
  return disparity;
}

std::vector<ImagePair> pairs_of_recording(const fs::path& folder, int every) {
  EvaluationRecording recording(folder);
  std::vector<ImagePair> pairs;
  for (std::size_t i = 0; i < recording.frame_count(); i += static_cast<std::size_t>(every)) {
    const EvaluationFrame frame = recording.frame(i);
    pairs.push_back({fmt::format("{}", frame.pair.t_ns), frame.pair.left, frame.pair.right,
                     disparity_of(frame.truth, recording.rig())});
  }
  return pairs;
}

bool holds_a_pair(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "left.png", ignored) && fs::exists(folder / "right.png", ignored);
}

ImagePair pair_of_files(const fs::path& folder) {
  ImagePair pair{folder.filename().string(),
                 read_gray_image(folder / "left.png"),
                 read_gray_image(folder / "right.png"),
                 {}};
  for (const char* name : {"disparity.png", "disparity.pfm"})
    if (std::error_code ignored; fs::exists(folder / name, ignored))
      pair.disparity_px = read_disparity_file(folder / name);
  if (pair.right.size() != pair.left.size())
    throw ScenarioError(fmt::format("{}: must be {}x{} as left.png, is {}x{}",
                                    (folder / "right.png").string(), pair.left.cols, pair.left.rows,
                                    pair.right.cols, pair.right.rows));
  if (!pair.disparity_px.empty() && pair.disparity_px.size() != pair.left.size())
    throw ScenarioError(fmt::format("{}: the disparities must be {}x{} as left.png, are {}x{}",
                                    folder.string(), pair.left.cols, pair.left.rows, pair.disparity_px.cols,
                                    pair.disparity_px.rows));
  return pair;
}

}  // namespace

std::vector<ImagePair> read_image_pairs(const fs::path& given, int every) {
  const QuietStandardError quiet;  // image libraries complain there on their own
  std::error_code ignored;
  const fs::path folder = fs::absolute(given).lexically_normal();
  if (!fs::is_directory(folder, ignored))
    throw ScenarioError(fmt::format("{}: there is no such folder", given.string()));
  if (euroc_folder(folder)) return pairs_of_recording(folder, every);
  std::vector<fs::path> folders;
  if (holds_a_pair(folder)) folders.push_back(folder.has_filename() ? folder : folder.parent_path());
  if (folders.empty())
    for (const auto& entry : fs::directory_iterator(folder))
      if (holds_a_pair(entry.path())) folders.push_back(entry.path());
  if (folders.empty())
    throw ScenarioError(
        fmt::format("{}: expected a recording in EuRoC's layout, left.png and right.png, or folders with "
                    "left.png and right.png",
                    given.string()));
  std::ranges::sort(folders);
  std::vector<ImagePair> pairs;
  for (const fs::path& one : folders) pairs.push_back(pair_of_files(one));
  return pairs;
}

ImagePair narrowed(const ImagePair& pair, int width_px) {
  if (pair.left.cols <= width_px) return pair;
  const double scale = static_cast<double>(width_px) / pair.left.cols;
  const cv::Size size(width_px, static_cast<int>(std::lround(scale * pair.left.rows)));
  ImagePair narrow{pair.name, {}, {}, {}};
  cv::resize(pair.left, narrow.left, size, 0, 0, cv::INTER_AREA);
  cv::resize(pair.right, narrow.right, size, 0, 0, cv::INTER_AREA);
  if (!pair.disparity_px.empty()) {
    cv::resize(pair.disparity_px, narrow.disparity_px, size, 0, 0, cv::INTER_NEAREST);
    narrow.disparity_px *= scale;
  }
  return narrow;
}

}  // namespace understory
