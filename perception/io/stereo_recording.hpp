#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/core/types.hpp>
#include <optional>
#include <vector>

#include "perception/io/image_sequence.hpp"
#include "perception/stereo_frame.hpp"

namespace understory {

class SideBySideVideo;

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
  /// side-by-side video. Reads the first pair. Throws std::runtime_error, one line that names the file, where
  /// the inputs are none of these or cannot be read.
  explicit StereoRecording(const std::vector<std::filesystem::path>& inputs);
  ~StereoRecording();

  /// The next pair, false at the end. Throws std::runtime_error, one line that names the file, at an image
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
  std::unique_ptr<SideBySideVideo> video_;
  std::filesystem::path first_file_;
  StereoFrame first_;  ///< read ahead, to know the size
  std::size_t next_ = 0;
  bool first_is_due_ = true;
};

}  // namespace understory
