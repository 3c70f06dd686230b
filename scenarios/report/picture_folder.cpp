#include "scenarios/report/picture_folder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/report/video_writer.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

bool is_numbered_picture(const fs::path& file) {
  const std::string stem = file.stem().string();
  return file.extension() == ".png" && stem.size() >= 6 &&
         std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

PictureFolder::PictureFolder(fs::path folder)
    : folder_(std::move(folder)), part_(folder_.string() + ".part") {
  remove_pictures(part_);
  prepare_output_folder(part_);
}

PictureFolder::~PictureFolder() {
  std::error_code ignored;
  fs::remove_all(part_, ignored);
}

void PictureFolder::add(const cv::Mat& picture) {
  write_png(part_ / fmt::format("{:06}.png", count_++), picture);
}

void PictureFolder::finish() {
  remove_pictures(folder_);
  std::error_code error;
  fs::rename(part_, folder_, error);
  if (error)
    throw ScenarioError(fmt::format("{}: expected a writable output: {}", folder_.string(), error.message()));
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
  if (error)
    throw ScenarioError(fmt::format("{}: expected a writable output: {}", folder.string(), error.message()));
}

}  // namespace understory
