#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

namespace understory {

/// All that this project uses of OpenCV's imgcodecs and videoio. These depend on two hundred shared
/// libraries, and loading them takes longer than all other preparation of a flight. So the program loads them
/// only when it first needs a film or a picture that is not PNG (png_codec.hpp,
/// scenarios/cli/late_picture_codecs.cpp, docs/decisions/014).
struct PictureCodecs {
  /// The image that these bytes hold, as it was stored; empty if they hold none or a damaged one. Throws
  /// cv::Exception if OpenCV refuses them. May print to stderr, as the film functions do.
  cv::Mat (*decode)(const std::string& bytes);
  /// The picture as a JPEG file; `quality` of 100.
  std::vector<unsigned char> (*encode_jpeg)(const cv::Mat& picture, int quality);
  /// A film for FFmpeg to read; isOpened() tells whether it can.
  std::unique_ptr<cv::VideoCapture> (*read_film)(const std::string& file);
  /// A film in H.264, BGR 8-bit; isOpened() is false where FFmpeg has no encoder for it.
  std::unique_ptr<cv::VideoWriter> (*write_film)(const std::string& file, double frames_per_s, cv::Size size);
};

/// perception_io defines it in picture_codecs.cpp, which links OpenCV's libraries, unless the program has a
/// definition of its own. Throws what that definition states.
const PictureCodecs& picture_codecs();

}  // namespace understory
