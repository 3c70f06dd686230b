#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "perception/obstacle_detector.hpp"
#include "perception/rectification/byte_remap.hpp"
#include "perception/stereo_calibration.hpp"
#include "perception/stereo_frame.hpp"

namespace understory {

enum class Interpolation { nearest, bilinear };

/// For each rectified pixel, row by row, the column and row of the raw pixel nearest to what it shows (may
/// lie outside the image): cv::convertMaps' places for nearest neighbours.
std::vector<std::int16_t> nearest_places(const CameraCalibration& camera, int width_px, int height_px);

/// Turns raw pairs into rectified ones, as cv::remap does with the maps of cv::initUndistortRectifyMap; the
/// maps are made once.
class Rectifier {
 public:
  Rectifier(const StereoCalibration& calibration, Interpolation interpolation);

  /// `raw`: CV_8UC1 images of the calibration's size (asserted). The images returned are the rectifier's own
  /// buffers: they hold until the next call. Pixels whose source lies outside the raw image are 0.
  StereoFrame rectify(const StereoFrame& raw);

 private:
  struct Eye {
    std::optional<ByteRemap> remap;  // for nearest, where the image is wide enough
    cv::Mat places, fractions;       // otherwise: cv::convertMaps' CV_16SC2 and, for bilinear, CV_16UC1
    cv::Mat image;
  };
  const cv::Mat& rectify(const cv::Mat& raw, Eye& eye);

  int width_px_, height_px_;
  Interpolation interpolation_;
  Eye left_, right_;
};

/// Gives raw pairs, rectified to the nearest pixel, to a detector that takes rectified ones only.
class RectifyingDetector : public ObstacleDetector {
 public:
  RectifyingDetector(const StereoCalibration& calibration, std::unique_ptr<ObstacleDetector> detector)
      : rectifier_(calibration, Interpolation::nearest), detector_(std::move(detector)) {}
  const std::vector<StereoHit>& detect(const StereoFrame& raw) override {
    return detector_->detect(rectifier_.rectify(raw));
  }

 private:
  Rectifier rectifier_;
  std::unique_ptr<ObstacleDetector> detector_;
};

}  // namespace understory
