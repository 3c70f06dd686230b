#pragma once

#include <opencv2/core/matx.hpp>
#include <string>
#include <vector>

#include "perception/io/strict_map.hpp"

namespace understory {

/// Matrices as cv::FileStorage writes them (rows, cols, dt d or f, data), from a map that holds them by name.
/// Every function throws as throw_file_fault does: no such matrix, another type or shape, a number that is
/// not finite or out of range, too few or too many of them.

cv::Matx33d opencv_rotation(StrictMap& map, const std::string& key);       ///< 3x3, orthonormal to 0.001
cv::Matx33d opencv_camera_matrix(StrictMap& map, const std::string& key);  ///< 3x3: fx 0 cx, 0 fy cy, 0 0 1
/// 3x4: f 0 cx t, 0 f cy 0, 0 0 1 0; t in focal lengths times the file's unit.
cv::Matx34d opencv_projection(StrictMap& map, const std::string& key);
cv::Vec3d opencv_translation(StrictMap& map, const std::string& key);  ///< 3x1 or 1x3, in the file's unit
/// None, 4, 5 or 8 coefficients in a row or a column; 12 or 14 where those past the 8th are 0, as
/// cv::stereoCalibrate leaves them.
std::vector<double> opencv_distortion(StrictMap& map, const std::string& key);

}  // namespace understory
