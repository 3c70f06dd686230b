#pragma once

#include "perception/stereo_calibration.hpp"
#include "perception/stereo_frame.hpp"

namespace understory {

enum class Interpolation { nearest, bilinear };

/// Turns raw pairs into rectified ones. The maps are made once (OpenCV's initUndistortRectifyMap).
class Rectifier {
 public:
  Rectifier(const StereoCalibration& calibration, Interpolation interpolation);

  /// `raw`: CV_8UC1 images of the calibration's size; a breach asserts. The images returned are the
  /// rectifier's own buffers: they hold until the next call. Pixels whose source lies outside the raw image
  /// are 0.
  StereoFrame rectify(const StereoFrame& raw);

 private:
  struct Eye {
    cv::Mat places, fractions;  // CV_16SC2 and, for bilinear, CV_16UC1 (cv::convertMaps)
    cv::Mat image;
  };
  int width_px_, height_px_;
  Interpolation interpolation_;
  Eye left_, right_;
};

}  // namespace understory
