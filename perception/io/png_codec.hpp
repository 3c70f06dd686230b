#pragma once

#include <opencv2/core/mat.hpp>
#include <string_view>
#include <vector>

namespace understory {

/// The image in the bytes of a PNG file, if it is of the kinds that recordings hold: 8- or 16-bit gray or
/// 8-bit BGR, not interlaced, without transparency. Empty if the bytes hold another kind, or no whole PNG:
/// OpenCV reads more kinds (picture_codecs.hpp), but loading it takes longer than reading some hundred
/// images.
cv::Mat decode_png(std::string_view bytes);

/// A PNG file of an 8- or 16-bit gray or an 8-bit BGR image, compressed fast rather than small: the bytes
/// that cv::imencode makes. Throws std::invalid_argument for other images and std::runtime_error where libpng
/// fails.
std::vector<unsigned char> encode_png(const cv::Mat& image);

}  // namespace understory
