#include "scenarios/evaluation/disparity_files.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "perception/io/image_file.hpp"
#include "perception/io/text_file.hpp"
#include "scenarios/output/errors.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr double steps_per_px = 256;  // KITTI's PNG
constexpr std::size_t maximum_pfm_bytes = std::size_t{64} << 20;

float swapped(float value) {
  auto bits = std::bit_cast<std::uint32_t>(value);
  bits = (bits >> 24U) | ((bits >> 8U) & 0xff00U) | ((bits << 8U) & 0xff0000U) | (bits << 24U);
  return std::bit_cast<float>(bits);
}

}  // namespace

bool names_a_folder(const std::string& name) {
  return !name.empty() && name.front() != '.' && name.find('/') == std::string::npos;
}

DisparityFolder disparity_folder_of(const std::string& argument) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == argument.size())
    throw ScenarioError(fmt::format("--disparities {}: must be NAME=FOLDER", argument));
  DisparityFolder given{argument.substr(0, equals), argument.substr(equals + 1)};
  if (!names_a_folder(given.name))
    throw ScenarioError(
        fmt::format("--disparities {}: the name becomes a folder's: no '/', no '.' first", argument));
  std::error_code ignored;
  if (!fs::is_directory(given.folder, ignored))
    throw ScenarioError(
        fmt::format("--disparities {}: there is no folder {}", argument, given.folder.string()));
  return given;
}

cv::Mat parse_pfm(const std::string& bytes, const std::string& name) {
  std::istringstream head(bytes.substr(0, 200));
  std::string kind;
  int width_px = 0, height_px = 0;
  double scale = 0;
  head >> kind >> width_px >> height_px >> scale;
  if (kind == "PF") throw InputError(name + ": expected a PFM of one channel (Pf), found three (PF)");
  if (kind != "Pf" || !head || width_px < 1 || height_px < 1 || width_px > 8192 || height_px > 8192 ||
      scale == 0)
    throw InputError(name + ": expected a PFM: Pf, width and height up to 8192, scale");
  const std::size_t begin = static_cast<std::size_t>(head.tellg()) + 1;  // one blank follows the scale
  const std::size_t size =
      sizeof(float) * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  if (bytes.size() != begin + size)
    throw InputError(fmt::format("{}: expected {} bytes of pixels for {}x{}, found {}", name, size, width_px,
                                 height_px, bytes.size() - std::min(begin, bytes.size())));
  cv::Mat image(height_px, width_px, CV_32FC1);
  const bool other_end_first = (scale > 0) == (std::endian::native == std::endian::little);
  for (int row = 0; row < height_px; ++row) {  // the bottom row comes first
    auto* to = image.ptr<float>(height_px - 1 - row);
    std::memcpy(to, bytes.data() + begin + sizeof(float) * static_cast<std::size_t>(row * width_px),
                sizeof(float) * static_cast<std::size_t>(width_px));
    if (other_end_first)
      for (int column = 0; column < width_px; ++column) to[column] = swapped(to[column]);
  }
  return image;
}

cv::Mat read_disparity_file(const fs::path& file) {
  if (file.extension() == ".pfm") return parse_pfm(read_file(file, maximum_pfm_bytes), file.string());
  const cv::Mat steps = read_gray_image(file, CV_16U);
  cv::Mat disparity;
  steps.convertTo(disparity, CV_32FC1, 1 / steps_per_px);
  disparity.setTo(std::numeric_limits<float>::quiet_NaN(), steps == 0);
  return disparity;
}

cv::Mat read_disparity(const fs::path& folder, std::int64_t t_ns, const StereoRig& rig) {
  std::error_code ignored;
  const fs::path pfm = folder / fmt::format("{}.pfm", t_ns), png = folder / fmt::format("{}.png", t_ns);
  const bool is_pfm = fs::exists(pfm, ignored);
  const fs::path& file = is_pfm ? pfm : png;
  if (!is_pfm && !fs::exists(png, ignored))
    throw ScenarioError(fmt::format("{}: there is no {}.pfm or {}.png, named as the pair's left image",
                                    folder.string(), t_ns, t_ns));
  cv::Mat disparity = read_disparity_file(file);
  if (disparity.cols != rig.width_px || disparity.rows != rig.height_px)
    throw ScenarioError(fmt::format("{}: must be {}x{} as the recording's images, is {}x{}", file.string(),
                                    rig.width_px, rig.height_px, disparity.cols, disparity.rows));
  for (int row = 0; row < disparity.rows; ++row)
    for (int column = 0; column < disparity.cols; ++column) {
      const float value = disparity.at<float>(row, column);
      if (std::isfinite(value) && value < 0 && rig.infinity_disparity_px() >= 0)
        throw ScenarioError(fmt::format(
            "{}: column {}, row {}: a disparity is u_left - u_right, on this rig at least 0, got {:g}",
            file.string(), column, row, value));
    }
  return disparity;
}

cv::Mat depth_of_disparity(const cv::Mat& disparity_px, const StereoRig& rig) {
  cv::Mat depth_m = cv::Mat::zeros(disparity_px.size(), CV_32FC1);
  for (int row = 0; row < disparity_px.rows; ++row)
    for (int column = 0; column < disparity_px.cols; ++column) {
      const double parallax_px = disparity_px.at<float>(row, column) - rig.infinity_disparity_px();
      if (std::isfinite(parallax_px) && parallax_px > 0)
        depth_m.at<float>(row, column) = static_cast<float>(rig.focal_px * rig.baseline_m / parallax_px);
    }
  return depth_m;
}

void DisparityErrors::count(const cv::Mat& depth_m, const cv::Mat& true_depth_mm, const StereoRig& rig) {
  for (int row = 0; row < true_depth_mm.rows; ++row)
    for (int column = 0; column < true_depth_mm.cols; ++column) {
      const double true_m = 1e-3 * true_depth_mm.at<std::uint16_t>(row, column);
      if (true_m <= 0) continue;
      ++true_pixels;
      const double found_m = depth_m.at<float>(row, column);
      if (found_m <= 0) continue;
      ++matched;
      const double error_px = std::abs(rig.disparity_px(found_m) - rig.disparity_px(true_m));
      sum_px += error_px;
      bad_1 += error_px > 1;
      bad_2 += error_px > 2;
      bad_4 += error_px > 4;
    }
}

void DisparityErrors::add(const DisparityErrors& other) {
  true_pixels += other.true_pixels;
  matched += other.matched;
  bad_1 += other.bad_1;
  bad_2 += other.bad_2;
  bad_4 += other.bad_4;
  sum_px += other.sum_px;
}

}  // namespace understory
