#include "scenarios/evaluation/image_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
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

/// Infinite where nothing is known: there the depth is 0.
cv::Mat disparity_of(const TrueImages& truth, const StereoRig& rig) {
  if (truth.depth_mm.empty()) return {};
  cv::Mat depth_m;
  truth.depth_mm.convertTo(depth_m, CV_32F, 1e-3);
  return rig.focal_px * rig.baseline_m / depth_m + rig.infinity_disparity_px();
}

std::vector<ImagePair> pairs_of_recording(const fs::path& folder, int every) {
  EvaluationRecording recording(folder);
  std::vector<ImagePair> pairs;
  for (std::size_t i = 0; i < recording.frame_count(); i += static_cast<std::size_t>(every)) {
    const EvaluationFrame frame = recording.frame(i);
    pairs.push_back({fmt::format("{}", frame.pair.t_ns), frame.pair.left, frame.pair.right,
                     disparity_of(frame.truth, recording.rig()), recording.rig()});
  }
  return pairs;
}

/// Where a pair lies; what is not there is empty.
struct PairFiles {
  std::string name;
  fs::path left, right, disparity, calibration;
  bool is_colour_pair = false;  ///< of KITTI's
};

fs::path first_there(const std::vector<fs::path>& files) {
  std::error_code ignored;
  const auto found =
      std::ranges::find_if(files, [&](const fs::path& file) { return fs::exists(file, ignored); });
  return found == files.end() ? fs::path() : *found;
}

/// Nothing where the folder holds no pair.
std::optional<PairFiles> files_of_folder(const fs::path& folder) {
  const fs::path gt = fs::path(folder.parent_path().string() + "_gt") / folder.filename();
  for (const auto& [left, right] : {std::pair("left.png", "right.png"), {"im0.png", "im1.png"}})
    if (!first_there({folder / left, folder / right}).empty())
      return PairFiles{folder.filename().string(), folder / left, folder / right,
                       first_there({folder / "disparity.png", folder / "disparity.pfm",
                                    folder / "disp0GT.pfm", folder / "disp0.pfm", gt / "disp0GT.pfm"}),
                       first_there({folder / "calib.txt"})};
  return std::nullopt;
}

/// Of the first image of each of KITTI's pairs, 000000_10.png, which alone has disparities.
std::vector<PairFiles> files_of_kitti(const fs::path& folder) {
  std::vector<PairFiles> pairs;
  for (const fs::path& training : {folder, folder / "training"})
    for (const auto& [left, right, truth, calibration] :
         {std::array{"image_0", "image_1", "disp_occ", "calib"},
          std::array{"image_2", "image_3", "disp_occ_0", "calib_cam_to_cam"}}) {
      std::error_code none;
      for (const auto& entry : fs::directory_iterator(training / truth, none)) {
        const std::string name = entry.path().filename().string();
        if (!name.ends_with("_10.png")) continue;
        const std::string number = name.substr(0, name.size() - 7);
        pairs.push_back({number, training / left / name, training / right / name, entry.path(),
                         first_there({training / calibration / (number + ".txt")}),
                         left == std::string("image_2")});
      }
    }
  return pairs;
}

ImagePair pair_of_files(const PairFiles& files) {
  ImagePair pair{files.name, read_image_as_gray(files.left), read_image_as_gray(files.right), {}};
  if (!files.disparity.empty()) pair.disparity_px = read_disparity_file(files.disparity);
  const std::string left_name = files.left.filename().string();
  if (pair.right.size() != pair.left.size())
    throw ScenarioError(fmt::format("{}: must be {}x{} as {}, is {}x{}", files.right.string(), pair.left.cols,
                                    pair.left.rows, left_name, pair.right.cols, pair.right.rows));
  if (!pair.disparity_px.empty() && pair.disparity_px.size() != pair.left.size())
    throw ScenarioError(fmt::format("{}: the disparities must be {}x{} as {}, are {}x{}",
                                    files.disparity.string(), pair.left.cols, pair.left.rows, left_name,
                                    pair.disparity_px.cols, pair.disparity_px.rows));
  if (files.calibration.empty()) return pair;
  CalibrationOptions options;
  options.images_at_hand = pair.left.size();
  options.of_colour_pair = files.is_colour_pair;
  pair.rig = bad_input_if_refused([&] { return read_calibrated_rig(files.calibration, options).rig; });
  if (cv::Size(pair.rig->width_px, pair.rig->height_px) != pair.left.size())
    throw ScenarioError(fmt::format("{}: is of images of {}x{}, {} has {}x{}", files.calibration.string(),
                                    pair.rig->width_px, pair.rig->height_px, left_name, pair.left.cols,
                                    pair.left.rows));
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
  std::vector<PairFiles> files = files_of_kitti(folder);
  if (auto own = files_of_folder(folder.has_filename() ? folder : folder.parent_path()))
    files.push_back(*own);
  if (files.empty())  // of a recording in Middlebury's form, or the folder above pairs
    for (const auto& entry :
         fs::directory_iterator(fs::exists(folder / "pairs", ignored) ? folder / "pairs" : folder))
      if (auto own = files_of_folder(entry.path())) files.push_back(*own);
  if (files.empty())
    throw ScenarioError(fmt::format(
        "{}: expected a recording in EuRoC's layout, KITTI's folder, left.png and right.png, im0.png "
        "and im1.png, or folders with these",
        given.string()));
  std::ranges::sort(files, {}, &PairFiles::left);
  std::vector<ImagePair> pairs;
  for (std::size_t i = 0; i < files.size(); i += static_cast<std::size_t>(every))
    pairs.push_back(pair_of_files(files[i]));
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
