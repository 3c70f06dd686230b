#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>

#include "perception/stereo_frame.hpp"

namespace understory {

/// Whether the name ends as a video's does (mp4, m4v, mov, mkv, avi, webm, mpg, mpeg, ogv), whatever the
/// case.
bool is_video_name(const std::filesystem::path& file);

/// A video whose pictures hold the left image in their left half and the right image in their right half.
/// Colour becomes gray, as video codecs know no other (a gray one comes back as it was). Not copyable.
class SideBySideVideo {
 public:
  /// Throws std::runtime_error "file: expected ..." where there is nothing to decode or the width is odd.
  explicit SideBySideVideo(const std::filesystem::path& file);

  /// The next pair; t_ns counts from the video's start at its rate. False at the end. The images stay the
  /// caller's.
  bool read(StereoFrame& frame);

  double rate_hz() const { return rate_hz_; }
  std::int64_t claimed_count() const { return claimed_count_; }    ///< by the container; some only estimate
  cv::Size image_size() const { return {width_px_, height_px_}; }  ///< of one eye

 private:
  std::filesystem::path file_;
  std::unique_ptr<cv::VideoCapture> capture_;
  double rate_hz_ = 0;
  std::int64_t claimed_count_ = 0, next_ = 0;
  int width_px_ = 0, height_px_ = 0;
};

}  // namespace understory
