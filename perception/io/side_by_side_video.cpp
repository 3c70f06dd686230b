#include "perception/io/side_by_side_video.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "perception/io/picture_codecs.hpp"

namespace understory {

// By name, because FFmpeg takes anything for a video: it renders plain text as one.
bool is_video_name(const std::filesystem::path& file) {
  constexpr std::array<const char*, 9> endings{".mp4",  ".m4v", ".mov",  ".mkv", ".avi",
                                               ".webm", ".mpg", ".mpeg", ".ogv"};
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

SideBySideVideo::SideBySideVideo(const std::filesystem::path& file)
    : file_(file), capture_(picture_codecs().read_film(file.string())) {
  const auto expect = [&](bool holds, const std::string& what) {
    if (!holds) throw std::runtime_error(file.string() + ": expected " + what);
  };
  expect(capture_->isOpened(), "a video that FFmpeg decodes");
  rate_hz_ = capture_->get(cv::CAP_PROP_FPS);
  expect(rate_hz_ > 0 && std::isfinite(rate_hz_), "a video that tells its rate");
  claimed_count_ =
      std::max<std::int64_t>(0, std::llround(std::clamp(capture_->get(cv::CAP_PROP_FRAME_COUNT), 0.0, 1e12)));
  const int both_px = static_cast<int>(capture_->get(cv::CAP_PROP_FRAME_WIDTH));
  height_px_ = static_cast<int>(capture_->get(cv::CAP_PROP_FRAME_HEIGHT));
  expect(both_px > 0 && height_px_ > 0, "a video with pictures");
  expect(both_px % 2 == 0,
         "left and right image side by side, so an even width, found " + std::to_string(both_px));
  width_px_ = both_px / 2;
}

bool SideBySideVideo::read(StereoFrame& frame) {
  cv::Mat picture, gray;
  if (!capture_->read(picture)) return false;
  if (picture.cols != 2 * width_px_ || picture.rows != height_px_)
    throw std::runtime_error(file_.string() + ": expected pictures of one size, found another in number " +
                             std::to_string(next_));
  if (picture.channels() == 3)
    cv::cvtColor(picture, gray, cv::COLOR_BGR2GRAY);
  else
    gray = picture;
  frame.t_ns = std::llround(static_cast<double>(next_++) * 1e9 / rate_hz_);
  frame.left = gray.colRange(0, width_px_).clone();
  frame.right = gray.colRange(width_px_, 2 * width_px_).clone();
  return true;
}

}  // namespace understory
