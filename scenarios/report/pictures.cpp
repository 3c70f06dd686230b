#include "scenarios/report/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/videoio.hpp>
#include <vector>

#include "perception/io/picture_codecs.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

bool is_numbered_picture(const fs::path& file) {
  const std::string stem = file.stem().string();
  return file.extension() == ".png" && stem.size() >= 6 &&
         std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

void write_png(const fs::path& file, const cv::Mat& picture) {
  const std::vector<unsigned char> bytes = picture_codecs().encode(".png", picture);
  write_whole_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

PictureFolder::PictureFolder(fs::path folder)
    : folder_(std::move(folder)), part_(folder_.string() + ".part") {
  remove_pictures(part_.path());
  prepare_output_folder(part_.path());
}

void PictureFolder::add(const cv::Mat& picture) {
  write_png(part_.path() / fmt::format("{:06}.png", count_++), picture);
}

void PictureFolder::finish() {
  remove_pictures(folder_);
  part_.become(folder_);
}

void remove_pictures(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(folder, error))) return;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const bool is_of_ours = is_numbered_picture(entry->path()) || entry->path().extension() == ".part";
    if (!is_of_ours)
      throw ScenarioError(fmt::format("{}: expected nothing here but pictures of an earlier run, found {}",
                                      folder.string(), entry->path().filename().string()));
  }
  if (!error) fs::remove_all(folder, error);
  if (error) refuse_output(folder, error.value());
}

VideoFile::VideoFile(fs::path file, double frames_per_s)
    : file_(std::move(file)),
      part_(file_.parent_path() / (file_.stem().string() + ".part" + file_.extension().string())),
      rate_hz_(frames_per_s) {}

VideoFile::~VideoFile() = default;

void VideoFile::add(const cv::Mat& picture) {
  if (!writer_) {
    auto writer = picture_codecs().write_film(part_.path().string(), rate_hz_, picture.size());
    if (!writer->isOpened())
      throw MachineError(fmt::format("{}: OpenCV's FFmpeg offers no H.264 encoder", file_.string()));
    writer_ = std::move(writer);
  }
  writer_->write(picture);
  ++picture_count_;
}

void VideoFile::finish() {
  if (!writer_) return;
  writer_->release();
  // The encoder reports no failed write: see whether the disk is full and whether the file's index reads
  // back.
  require_free_space(file_, 1 << 16);
  const auto reader = picture_codecs().read_film(part_.path().string());
  if (!reader->isOpened() || static_cast<int>(reader->get(cv::CAP_PROP_FRAME_COUNT)) != picture_count_) {
    throw MachineError(fmt::format("{}: what was written does not read back whole", file_.string()));
  }
  part_.become(file_);
}

}  // namespace understory
