#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

namespace understory {

/// Whether the name ends as an image's does (png, jpg, jpeg, bmp, tif, tiff, pgm), whatever the case.
bool is_image_name(const std::filesystem::path& file);

/// Reads an 8-bit gray image (CV_8UC1), never converting: matching 16-bit or coloured pictures at 8-bit
/// gray's thresholds would only look like working. Throws std::runtime_error "file: expected ..., found ..."
/// where the file is missing, no image, damaged, or of another kind. The image libraries may print to stderr.
cv::Mat read_gray_image(const std::filesystem::path& file);

}  // namespace understory
