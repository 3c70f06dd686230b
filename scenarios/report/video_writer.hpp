#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>

namespace understory {

/// H.264 in mp4, which browsers play. Written under another name and renamed by finish(), so that a
/// broken-off video does not look whole.
class VideoFile {
 public:
  VideoFile(std::filesystem::path file, double frames_per_s)
      : file_(std::move(file)), rate_hz_(frames_per_s) {}
  ~VideoFile();  ///< removes what finish() has not made whole
  /// BGR 8-bit, every picture of the size of the first (even width and height). Throws MachineError where no
  /// H.264 encoder is installed, ScenarioError where the file cannot be made.
  void add(const cv::Mat& picture);
  /// Throws MachineError where the disk filled up or the file does not read back.
  void finish();

 private:
  std::filesystem::path part() const;

  std::filesystem::path file_;
  double rate_hz_;
  int picture_count_ = 0;
  std::unique_ptr<cv::VideoWriter> writer_;  ///< from the first picture on
};

/// A picture as PNG, whole or not at all.
void write_png(const std::filesystem::path& file, const cv::Mat& picture);

}  // namespace understory
