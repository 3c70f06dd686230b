#include "perception/rectify.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "perception/assertion.hpp"

namespace understory {

Rectifier::Rectifier(const StereoCalibration& calibration, Interpolation interpolation)
    : width_px_(calibration.width_px), height_px_(calibration.height_px), interpolation_(interpolation) {
  const auto prepare = [&](const CameraCalibration& camera, Eye& eye) {
    cv::Mat u, v;
    cv::initUndistortRectifyMap(camera.camera_matrix, camera.distortion, camera.rectification,
                                camera.projection, {width_px_, height_px_}, CV_32FC1, u, v);
    cv::convertMaps(u, v, eye.places, eye.fractions, CV_16SC2, interpolation == Interpolation::nearest);
  };
  prepare(calibration.left, left_);
  prepare(calibration.right, right_);
}

StereoFrame Rectifier::rectify(const StereoFrame& raw) {
  const auto remap = [this](const cv::Mat& image, Eye& eye) {
    assert_always(image.type() == CV_8UC1 && image.cols == width_px_ && image.rows == height_px_,
                  "a raw image must be 8-bit gray and of the calibration's size");
    cv::remap(image, eye.image, eye.places, eye.fractions,
              interpolation_ == Interpolation::nearest ? cv::INTER_NEAREST : cv::INTER_LINEAR,
              cv::BORDER_CONSTANT);
    return eye.image;
  };
  return {raw.t_ns, remap(raw.left, left_), remap(raw.right, right_)};
}

}  // namespace understory
