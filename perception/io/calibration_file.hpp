#pragma once

#include <filesystem>
#include <optional>

#include "perception/stereo_calibration.hpp"

namespace understory {

/// What some calibration formats do not say themselves.
struct CalibrationOptions {
  double meters_per_unit = 1;              ///< of the file's translations: 0.01 where they are in centimetres
  std::optional<int> width_px, height_px;  ///< of the images, where the files do not tell
  std::optional<double> detection_depth_m;  ///< goes before the rig file's own; 10 m where nobody says
};

/// A rig as read: rectified, and with the raw cameras where the files have them (absent: images come
/// rectified).
struct CalibratedRig {
  StereoRig rig;
  std::optional<StereoCalibration> calibration;
};

/// Reads a rig from any of
/// - our own rig file (YAML, read_rig),
/// - one OpenCV XML or YAML file with M1 D1 M2 D2 and either R1 R2 P1 P2 or R T (then rectified here with
///   cv::stereoRectify), names as OpenCV's stereo_calib sample writes them,
/// - a folder of OpenCV files, one matrix each (M1.xml, D1.xml, R1.xml, P1.xml, M2.xml ...),
/// - a EuRoC/ASL folder (mav0, or the folder above it): cam0/sensor.yaml and cam1/sensor.yaml.
/// Throws std::runtime_error "file[:line]: key: what was expected" at anything missing, mistyped or out of
/// range, and where images' size is needed and nobody says it.
CalibratedRig read_calibrated_rig(const std::filesystem::path& path, const CalibrationOptions& options);

}  // namespace understory
