#pragma once

#include <filesystem>

#include "perception/io/calibration_file.hpp"

namespace understory {

/// Reads the raw pair from one OpenCV XML or YAML file, or from a folder of them: one matrix a file, named as
/// the matrix (M1.xml), or intrinsics.yml and extrinsics.yml as OpenCV's stereo_calib sample writes them.
/// Read are M1 D1 M2 D2 and either R1 R2 P1 P2 or R T (then rectified here), and image_width, image_height
/// where they are; other keys are left alone. The files know no body: the left camera is put at its origin,
/// looking along body x. Errors: see read_calibrated_rig.
StereoCalibration read_opencv_calibration(const std::filesystem::path& path,
                                          const CalibrationOptions& options);

/// Whether `text` is XML or OpenCV's kind of YAML (else it may be a rig file).
bool looks_like_opencv(const std::string& text);

}  // namespace understory
