#include "perception/io/stereo_recording.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>

#include "perception/io/image_file.hpp"
#include "perception/io/picture_codecs.hpp"
#include "perception/io/text_file.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr const char* what_serves =
    "expected a EuRoC folder, two folders of images, two images, or a side-by-side video";

ImageSequence sequence_of(const std::vector<fs::path>& inputs) {
  std::error_code ignored;
  for (const fs::path& input : inputs)
    if (!fs::exists(input, ignored)) throw InputError(input.string() + ": found no such file or folder");
  if (inputs.size() == 1 && fs::is_directory(inputs[0], ignored)) return euroc_sequence(inputs[0]);
  if (inputs.size() != 2)
    throw InputError((inputs.empty() ? "" : inputs[0].string() + ": ") + std::string(what_serves));
  if (fs::is_directory(inputs[0], ignored) && fs::equivalent(inputs[0], inputs[1], ignored))
    throw InputError(inputs[1].string() + ": is given twice, as the left images and as the right ones");
  const bool left_is_folder = fs::is_directory(inputs[0], ignored);
  if (left_is_folder != fs::is_directory(inputs[1], ignored))
    throw InputError(inputs[1].string() + ": " + what_serves);
  return left_is_folder ? folder_sequence(inputs[0], inputs[1]) : single_pair(inputs[0], inputs[1]);
}

std::string text_of_size(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace

SideBySideVideo::SideBySideVideo(const std::filesystem::path& file)
    : file_(file), capture_(picture_codecs().read_film(file.string())) {
  const auto expect = [&](bool holds, const std::string& what) {
    if (!holds) throw InputError(file.string() + ": expected " + what);
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
  expect(std::max(width_px_, height_px_) <= maximum_side_px, "images of at most 8192x8192 px");
}

SideBySideVideo::~SideBySideVideo() = default;

bool SideBySideVideo::read(StereoFrame& frame) {
  cv::Mat picture, gray;
  if (!capture_->read(picture)) return false;
  if (picture.cols != 2 * width_px_ || picture.rows != height_px_)
    throw InputError(file_.string() + ": all pictures must have one size, another size begins at number " +
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

StereoRecording::StereoRecording(const std::vector<fs::path>& inputs) {
  std::error_code ignored;
  if (inputs.size() == 1 && fs::is_regular_file(inputs[0], ignored)) {
    if (!is_video_name(inputs[0])) throw InputError(inputs[0].string() + ": " + what_serves);
    video_ = std::make_unique<SideBySideVideo>(inputs[0]);
    first_file_ = inputs[0];
    if (!video_->read(first_)) throw InputError(inputs[0].string() + ": holds no pictures");
    return;
  }
  sequence_ = sequence_of(inputs);
  if (inputs.size() == 2) image_depth_ = CV_8U;
  first_file_ = sequence_.pairs.front().left;
  first_.left =
      read_gray_image_of_8_or_16_bits(first_file_, image_depth_);  // the size that all others must have
  read_files(first_);
}

StereoRecording::~StereoRecording() = default;

std::int64_t StereoRecording::frame_count() const {
  return video_ ? video_->claimed_count() : static_cast<std::int64_t>(sequence_.pairs.size());
}

std::optional<TimeSpan> StereoRecording::times() const {
  if (video_) {
    const auto last = static_cast<double>(std::max<std::int64_t>(1, video_->claimed_count()) - 1);
    return TimeSpan{0, std::llround(last * 1e9 / video_->rate_hz())};
  }
  if (!sequence_.timed) return std::nullopt;
  return TimeSpan{sequence_.pairs.front().t_ns, sequence_.pairs.back().t_ns};
}

bool StereoRecording::read(StereoFrame& frame) {
  if (first_is_due_) {
    first_is_due_ = false;
    frame = first_;
    return true;
  }
  return video_ ? video_->read(frame) : read_files(frame);
}

bool StereoRecording::read_files(StereoFrame& frame) {
  if (next_ == sequence_.pairs.size()) return false;
  const StereoFiles& files = sequence_.pairs[next_++];
  const auto read_one = [&](const fs::path& file) {
    const cv::Mat image = read_gray_image_of_8_or_16_bits(file, image_depth_);
    if (image.size() != image_size())
      throw InputError(file.string() + ": expected " + text_of_size(image_size()) + " as " +
                       first_file_.string() + " has, found " + text_of_size(image.size()));
    return image;
  };
  const cv::Mat left = read_one(files.left), right = read_one(files.right);
  frame = {files.t_ns, left, right};
  return true;
}

}  // namespace understory
