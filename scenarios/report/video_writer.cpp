#include "scenarios/report/video_writer.hpp"

#include <fmt/format.h>

#include <vector>

#include "perception/io/picture_codecs.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {

std::filesystem::path VideoFile::part() const {
  return file_.parent_path() / (file_.stem().string() + ".part" + file_.extension().string());
}

void VideoFile::add(const cv::Mat& picture) {
  if (!writer_) {
    auto writer = picture_codecs().write_film(part().string(), rate_hz_, picture.size());
    if (!writer->isOpened())
      throw MachineError(fmt::format("{}: OpenCV's FFmpeg offers no H.264 encoder", file_.string()));
    writer_ = std::move(writer);
  }
  writer_->write(picture);
  ++picture_count_;
}

VideoFile::~VideoFile() {
  writer_.reset();
  std::error_code ignored;
  std::filesystem::remove(part(), ignored);
}

void VideoFile::finish() {
  if (!writer_) return;
  writer_->release();
  // The encoder reports no failed write: see whether the disk is full and whether the file's index reads
  // back.
  require_free_space(file_, 1 << 16);
  const auto reader = picture_codecs().read_film(part().string());
  if (!reader->isOpened() || static_cast<int>(reader->get(cv::CAP_PROP_FRAME_COUNT)) != picture_count_) {
    throw MachineError(fmt::format("{}: what was written does not read back whole", file_.string()));
  }
  std::filesystem::rename(part(), file_);
}

void write_png(const std::filesystem::path& file, const cv::Mat& picture) {
  const std::vector<unsigned char> bytes = picture_codecs().encode(".png", picture);
  write_whole_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace understory
