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

StereoCalibration raw_pair(const RawCamera& left, const RawCamera& right, const std::string& file,
                           const std::string& size_key, const CalibrationOptions& options) {
  if (left.size != right.size) right.map.fail(size_key, "must be that of the left camera");
  if (left.calibration.lens != right.calibration.lens)
    right.map.fail("distortion_model", "must be that of the left camera");
  const ImageSize size = agreed_image_size(file, left.size, options);
  return {"",
          size.width_px,
          size.height_px,
          left.calibration,
          right.calibration,
          T_body_camera_of(Eigen::Vector3d::Zero(), 0)};
}

void require_camera_matrix(StrictMap& map, const std::string& key, const cv::Matx33d& K) {
  if (K(0, 1) != 0 || K(1, 0) != 0 || K.row(2) != cv::Matx13d(0, 0, 1))
    map.fail(key, "must have the form fx 0 cx, 0 fy cy, 0 0 1");
  for (const double focal_px : {K(0, 0), K(1, 1)})
    if (!(focal_px >= minimum_focal_px && focal_px <= maximum_focal_px))
      map.fail(key, fmt::format("focal lengths must be from {} to {} px, one is {}", minimum_focal_px,
                                maximum_focal_px, focal_px));
  for (const double center_px : {K(0, 2), K(1, 2)})
    if (!(center_px >= minimum_center_px && center_px <= maximum_center_px))
      map.fail(key, fmt::format("the principal point must be from {} to {} px, is {}", minimum_center_px,
                                maximum_center_px, center_px));
}

void require_projection(StrictMap& map, const std::string& key, const cv::Matx34d& P) {
  if (P(0, 1) != 0 || P(1, 0) != 0 || P(1, 3) != 0 || P.row(2) != cv::Matx14d(0, 0, 1, 0))
    map.fail(key, "must have the form f 0 cx t, 0 f cy 0, 0 0 1 0, of rectified cameras side by side");
}

void require_rotation(StrictMap& map, const std::string& key, const cv::Matx33d& R) {
  constexpr double tolerance = 1e-3;
  if (!(cv::norm(R * R.t() - cv::Matx33d::eye(), cv::NORM_INF) < tolerance && cv::determinant(R) > 0))
    map.fail(key, "must be a rotation, row by row: orthonormal, determinant 1");
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

void rectify_pair(StereoCalibration& calibration, const cv::Matx33d& R_right_left, const cv::Vec3d& t_right_m,
                  const StrictMap& map, const std::string& key) {
  if (!(t_right_m[0] < 0))
    map.fail(key, "the right camera must lie to the right of the left one, here it does not");
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
    return;
  }
  const cv::Size size(calibration.width_px, calibration.height_px);
  cv::Mat disparity_to_depth;
  double sum = 0;  // finite only if every term is
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
    sum = NAN;
  }
  for (const CameraCalibration* camera : {&left, &right}) {
    for (const double value : camera->rectification.val) sum += value;
    for (const double value : camera->projection.val) sum += value;
  }
  if (!std::isfinite(sum)) map.fail(key, "OpenCV cannot bring the two cameras side by side");
}

cv::Matx33d pinhole_matrix(StrictMap& map, const std::string& key) {
  const std::vector<double> pinhole = map.numbers(key, 4, -1e9, 1e9);
  const cv::Matx33d K(pinhole[0], 0, pinhole[2], 0, pinhole[1], pinhole[3], 0, 0, 1);
  require_camera_matrix(map, key, K);
  return K;
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
