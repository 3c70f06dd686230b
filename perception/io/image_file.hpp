#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

namespace understory {

/// No image is wider or higher.
inline constexpr int maximum_side_px = 8192;

/// Whether the name ends as an image's does (png, jpg, jpeg, bmp, tif, tiff, pgm), in any case.
bool is_image_name(const std::filesystem::path& file);

/// Whether it ends as a video's does (mp4, m4v, mov, mkv, avi, webm, mpg, mpeg, ogv). By name, because FFmpeg
/// takes anything for a video: it renders plain text as one.
bool is_video_name(const std::filesystem::path& file);

/// Reads a gray image of the depth CV_8U (CV_8UC1) or CV_16U, without conversion: thresholds for 8-bit gray
/// would give wrong matches on converted pictures. Throws InputError "file: expected ..., found ..." where
/// the file is missing, larger than 256 MiB, no image of the kinds above, damaged, of another kind, or (told
/// from its header, before its pixels are read) wider or higher than 8192 px. The image libraries may print
/// to stderr.
cv::Mat read_gray_image(const std::filesystem::path& file, int depth = CV_8U);

/// The same of 16-bit images, too, scaled to 8 bits, as TUM-VI's need it. `depth`: of the images read before,
/// which this one must have, too; -1 before the first. Throws InputError where the upper four bits of all
/// pixels are 0: those are 12-bit numbers, which would become dark.
cv::Mat read_gray_image_of_8_or_16_bits(const std::filesystem::path& file, int& depth);

/// The same of 8-bit images that are in colour, too, as cv::cvtColor makes them gray: for comparing data
/// sets.
cv::Mat read_image_as_gray(const std::filesystem::path& file);

}  // namespace understory
