#include "perception/io/calibration/calibration_forms.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "perception/io/text_file.hpp"

namespace understory {

using namespace rig_limits;

ImageSize agreed_image_size(const std::string& file, std::optional<ImageSize> of_file,
                            const CalibrationOptions& options) {
  const auto fail = [&](const std::string& expected) { refuse_input(file, "image size", expected); };
  const auto in_range = [](int size_px) { return size_px >= minimum_size_px && size_px <= maximum_size_px; };
  if (options.width_px.has_value() != options.height_px.has_value())
    fail("image_width and image_height belong together, one is missing");
  if (!options.width_px) {
    if (of_file) return *of_file;
    if (options.images_at_hand) return {options.images_at_hand->width, options.images_at_hand->height};
    fail("not in the file (image_width, image_height): name it with --size WxH");
  }
  const ImageSize given{*options.width_px, *options.height_px};
  if (!in_range(given.width_px) || !in_range(given.height_px))
    fail(fmt::format("must be from {} to {} px, is {}x{}", minimum_size_px, maximum_size_px, given.width_px,
                     given.height_px));
  if (of_file && *of_file != given)
    fail(fmt::format("the file says {}x{}, --size says {}x{}", of_file->width_px, of_file->height_px,
                     given.width_px, given.height_px));
  return given;
}

bool has_camera_form(const cv::Matx33d& matrix) {
  return matrix(0, 1) == 0 && matrix(1, 0) == 0 && matrix.row(2) == cv::Matx13d(0, 0, 1);
}

bool has_projection_form(const cv::Matx34d& matrix) {
  return matrix(0, 1) == 0 && matrix(1, 0) == 0 && matrix(1, 3) == 0 &&
         matrix.row(2) == cv::Matx14d(0, 0, 1, 0);
}

bool is_rotation(const cv::Matx33d& matrix) {
  constexpr double tolerance = 1e-3;
  return cv::norm(matrix * matrix.t() - cv::Matx33d::eye(), cv::NORM_INF) < tolerance &&
         cv::determinant(matrix) > 0;
}

namespace {

/// Whether raw cameras are a rectified pair already, whose images should stay as they are.
bool are_aligned(const CameraCalibration& left, const CameraCalibration& right,
                 const cv::Matx33d& R_right_left, const cv::Vec3d& t_right_m) {
  const cv::Matx33d &K = left.camera_matrix, &other = right.camera_matrix;
  const bool is_equal =
      K(0, 0) == K(1, 1) && other(0, 0) == K(0, 0) && other(1, 1) == K(0, 0) && other(1, 2) == K(1, 2);
  return is_equal && !left.bends() && !right.bends() && R_right_left == cv::Matx33d::eye() &&
         t_right_m[0] < 0 && t_right_m[1] == 0 && t_right_m[2] == 0;
}

}  // namespace

bool rectify_pair(StereoCalibration& calibration, const cv::Matx33d& R_right_left,
                  const cv::Vec3d& t_right_m) {
  CameraCalibration& left = calibration.left;
  CameraCalibration& right = calibration.right;
  if (are_aligned(left, right, R_right_left, t_right_m)) {
    left.projection = cv::Matx34d::eye();
    for (int row = 0; row < 3; ++row)
      for (int col = 0; col < 3; ++col) {
        left.projection(row, col) = left.camera_matrix(row, col);
        right.projection(row, col) = right.camera_matrix(row, col);
      }
    right.projection(0, 3) = right.camera_matrix(0, 0) * t_right_m[0];
    return true;
  }
  const cv::Size size(calibration.width_px, calibration.height_px);
  cv::Mat disparity_to_depth;
  try {
    if (left.lens == LensModel::equidistant)
      cv::fisheye::stereoRectify(left.camera_matrix, left.distortion, right.camera_matrix, right.distortion,
                                 size, R_right_left, t_right_m, left.rectification, right.rectification,
                                 left.projection, right.projection, disparity_to_depth,
                                 cv::CALIB_ZERO_DISPARITY, size);
    else
      cv::stereoRectify(left.camera_matrix, left.distortion, right.camera_matrix, right.distortion, size,
                        R_right_left, t_right_m, left.rectification, right.rectification, left.projection,
                        right.projection, disparity_to_depth, cv::CALIB_ZERO_DISPARITY, 0, size);
  } catch (const cv::Exception&) {
    return false;  // the caller knows the file's name
  }
  double sum = 0;  // finite only if every term is
  for (const CameraCalibration* camera : {&left, &right}) {
    for (const double value : camera->rectification.val) sum += value;
    for (const double value : camera->projection.val) sum += value;
  }
  return std::isfinite(sum);
}

cv::Matx33d pinhole_matrix(StrictMap& map, const std::string& key) {
  const std::vector<double> pinhole = map.numbers(key, 4, minimum_center_px, maximum_focal_px);
  if (std::min(pinhole[0], pinhole[1]) < minimum_focal_px ||
      std::max(pinhole[2], pinhole[3]) > maximum_center_px)
    map.fail(
        key,
        "must be fu, fv, cu, cv in px: here a focal length is too short or a center too far from the image");
  return {pinhole[0], 0, pinhole[2], 0, pinhole[1], pinhole[3], 0, 0, 1};
}

ImageSize resolution(StrictMap& map, const std::string& key) {
  const std::vector<double> size = map.numbers(key, 2, minimum_size_px, maximum_size_px);
  if (size[0] != std::floor(size[0]) || size[1] != std::floor(size[1]))
    map.fail(key, "must be whole numbers");
  return {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

LensModel lens_model(StrictMap& map, const std::string& key, std::span<const LensWord> words) {
  const std::string found = map.text(key);
  const auto word = std::ranges::find(words, found, &LensWord::word);
  if (word != words.end()) return word->lens;
  std::string known;
  for (const LensWord& one : words) known += (known.empty() ? "" : " or ") + std::string(one.word);
  map.fail(key, "expected " + known + ", found '" + found + "'");
}

void require_text(StrictMap& map, const std::string& key, const std::string& expected) {
  if (const std::string found = map.text(key); found != expected)
    map.fail(key, "expected " + expected + ", found '" + found + "'");
}

void require_metres(const std::string& file, const std::string& form, const CalibrationOptions& options) {
  if (options.meters_per_unit)
    refuse_input(file, "unit", form + " is in metres: --unit is for OpenCV's and ROS's files");
}

std::string calibration_text(const std::filesystem::path& file) {
  const std::string packed = read_file(file);
  if (!packed.starts_with("\x1f\x8b")) return packed;
  std::string text(maximum_keyed_bytes + 1, '\0');
  gzFile stream = gzopen(file.c_str(), "rb");
  const int count = stream == nullptr ? -1 : gzread(stream, text.data(), static_cast<unsigned>(text.size()));
  const bool is_whole = stream != nullptr && gzclose(stream) == Z_OK && count >= 0;
  text.resize(static_cast<std::size_t>(std::max(0, count)));
  if (text.size() > maximum_keyed_bytes)
    refuse_input(file.string(), "",
                 fmt::format("unpacked, a file may hold at most {} bytes", maximum_keyed_bytes));
  if (!is_whole) refuse_input(file.string(), "", "not whole: its gzip data are broken or end early");
  return text;
}

}  // namespace understory
