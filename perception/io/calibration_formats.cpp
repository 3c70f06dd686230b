#include "perception/io/calibration_formats.hpp"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/calib3d.hpp>

#include "perception/io/text_file.hpp"

namespace understory {

ImageSize agreed_image_size(const std::string& file, std::optional<ImageSize> of_file,
                            const CalibrationOptions& options) {
  using namespace rig_limits;
  const auto fail = [&](const std::string& expected) { refuse_input(file, "image size", expected); };
  const auto in_range = [](int size_px) { return size_px >= minimum_size_px && size_px <= maximum_size_px; };
  if (options.width_px.has_value() != options.height_px.has_value()) fail("expected a width and a height");
  if (!options.width_px) {
    if (!of_file)
      fail("expected in the file (image_width, image_height) or with it (--size WxH), found none");
    return *of_file;
  }
  const ImageSize given{*options.width_px, *options.height_px};
  if (!in_range(given.width_px) || !in_range(given.height_px))
    fail(fmt::format("expected {} to {} px, was given {}x{}", minimum_size_px, maximum_size_px,
                     given.width_px, given.height_px));
  if (of_file && *of_file != given)
    fail(fmt::format("expected the file's own, {}x{}, was given {}x{}", of_file->width_px, of_file->height_px,
                     given.width_px, given.height_px));
  return given;
}

bool is_rotation(const cv::Matx33d& matrix) {
  constexpr double tolerance = 1e-3;
  return cv::norm(matrix * matrix.t() - cv::Matx33d::eye(), cv::NORM_INF) < tolerance &&
         cv::determinant(matrix) > 0;
}

bool rectify_pair(StereoCalibration& calibration, const cv::Matx33d& R_right_left,
                  const cv::Vec3d& t_right_m) {
  CameraCalibration& left = calibration.left;
  CameraCalibration& right = calibration.right;
  const cv::Size size(calibration.width_px, calibration.height_px);
  cv::Mat disparity_to_depth;
  try {
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

}  // namespace understory
