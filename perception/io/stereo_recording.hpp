#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "perception/io/image_sequence.hpp"
#include "perception/stereo_frame.hpp"

namespace cv {
class VideoCapture;
}

namespace understory {

/// A video whose pictures hold the left image in their left half and the right image in their right half.
/// Colour is converted to gray: video codecs store colour only (gray is restored unchanged). Not copyable.
class SideBySideVideo {
 public:
  /// Throws InputError "file: expected ..." where there is nothing to decode or the width is odd.
  explicit SideBySideVideo(const std::filesystem::path& file);
  ~SideBySideVideo();

  /// The next pair; t_ns counts from the video's start at its rate. False at the end. The images belong to
  /// the caller.
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

/// Moments between which a recording's images lie.
struct TimeSpan {
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
};

/// Stereo pairs that somebody recorded, read one after the other. All images are 8-bit gray and of the size
/// of the first.
class StereoRecording {
 public:
  /// `inputs`: a EuRoC/ASL folder; a left and a right folder of images; a left and a right image; or one
  /// side-by-side video. Reads the first pair. Throws InputError, one line that names the file, where
  /// the inputs are none of these or cannot be read.
  explicit StereoRecording(const std::vector<std::filesystem::path>& inputs);
  ~StereoRecording();

  /// The next pair, false at the end. Throws InputError, one line that names the file, at an image
  /// that is missing, damaged, not 8-bit gray, or of another size than the first.
  bool read(StereoFrame& frame);

  const std::filesystem::path& first_file() const { return first_file_; }
  cv::Size image_size() const { return {first_.left.cols, first_.left.rows}; }
  std::int64_t frame_count() const;  ///< for a video, what its container claims
  std::int64_t unpaired() const { return sequence_.unpaired; }
  /// Nothing where the images have no times: then every frame's t_ns is 0.
  std::optional<TimeSpan> times() const;

 private:
  bool read_files(StereoFrame& frame);

  ImageSequence sequence_;
  int image_depth_ = -1;  ///< of a EuRoC folder: 8 or 16 bits, as the first image
  std::unique_ptr<SideBySideVideo> video_;
  std::filesystem::path first_file_;
  StereoFrame first_;  ///< read ahead, to know the size
  std::size_t next_ = 0;
  bool first_is_due_ = true;
};

}  // namespace understory
