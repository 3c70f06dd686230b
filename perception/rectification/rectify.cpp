#include "perception/rectification/rectify.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "perception/assertion.hpp"

namespace understory {

namespace {

void make_maps(const CameraCalibration& camera, const cv::Size& size, bool nearest, cv::Mat& places,
               cv::Mat& fractions) {
  cv::Mat u, v;
  if (camera.lens == LensModel::equidistant)
    cv::fisheye::initUndistortRectifyMap(camera.camera_matrix, camera.distortion, camera.rectification,
                                         camera.projection, size, CV_32FC1, u, v);
  else
    cv::initUndistortRectifyMap(camera.camera_matrix, camera.distortion, camera.rectification,
                                camera.projection, size, CV_32FC1, u, v);
  cv::convertMaps(u, v, places, fractions, CV_16SC2, nearest);
}

}  // namespace

std::vector<std::int16_t> nearest_places(const CameraCalibration& camera, int width_px, int height_px) {
  cv::Mat places, fractions;
  make_maps(camera, {width_px, height_px}, true, places, fractions);
  const auto* first = places.ptr<std::int16_t>();
  return {first, first + 2 * places.total()};
}

Rectifier::Rectifier(const StereoCalibration& calibration, Interpolation interpolation)
    : width_px_(calibration.width_px), height_px_(calibration.height_px), interpolation_(interpolation) {
  const bool nearest = interpolation == Interpolation::nearest;
  const auto prepare = [&](const CameraCalibration& camera, Eye& eye) {
    eye.image.create(height_px_, width_px_, CV_8UC1);
    if (nearest && width_px_ >= ByteRemap::chunk_px) {
      eye.remap.emplace(nearest_places(camera, width_px_, height_px_), width_px_, height_px_, 0, width_px_);
    } else {
      make_maps(camera, {width_px_, height_px_}, nearest, eye.places, eye.fractions);
    }
  };
  prepare(calibration.left, left_);
  prepare(calibration.right, right_);
}

StereoFrame Rectifier::rectify(const StereoFrame& raw) {
  return {raw.t_ns, rectify(raw.left, left_), rectify(raw.right, right_)};
}

const cv::Mat& Rectifier::rectify(const cv::Mat& raw, Eye& eye) {
  assert_always(raw.type() == CV_8UC1 && raw.cols == width_px_ && raw.rows == height_px_,
                "a raw image must be 8-bit gray and of the calibration's size");
  if (eye.remap) {
    const GrayView source{raw.data, static_cast<std::ptrdiff_t>(raw.step[0]), raw.cols, raw.rows};
    eye.remap->prepare(source.stride);
    eye.remap->apply(source, 0, height_px_, eye.image.data, static_cast<std::ptrdiff_t>(eye.image.step[0]));
  } else {
    cv::remap(raw, eye.image, eye.places, eye.fractions,
              interpolation_ == Interpolation::nearest ? cv::INTER_NEAREST : cv::INTER_LINEAR,
              cv::BORDER_CONSTANT);
  }
  return eye.image;
}

}  // namespace understory
