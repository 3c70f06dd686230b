#include "scenarios/report/pictures.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <vector>

#include "perception/io/picture_codecs.hpp"
#include "perception/io/png_codec.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

const cv::Scalar blue(255, 64, 0);
const cv::Scalar red(0, 0, 255);
const cv::Scalar green(80, 220, 80);
const cv::Scalar yellow(0, 230, 255);
constexpr double mph_per_mps = 2.2369362920544;
constexpr double feet_per_m = 3.2808398950131;
constexpr double nearest_drawn_m = 0.5;

void write_text(cv::Mat& picture, const std::string& text, cv::Point place, double size) {
  constexpr int font = cv::FONT_HERSHEY_DUPLEX;
  const int thickness = size <= 0.8 ? 1 : 2;
  cv::putText(picture, text, place, font, size, cv::Scalar(0, 0, 0), thickness + 3, cv::LINE_AA);
  cv::putText(picture, text, place, font, size, cv::Scalar(255, 255, 255), thickness, cv::LINE_AA);
}

void write_at_side(cv::Mat& picture, const std::string& text, bool at_right) {
  constexpr double size = 0.7;
  int baseline = 0;
  const cv::Size extent = cv::getTextSize(text, cv::FONT_HERSHEY_DUPLEX, size, 2, &baseline);
  write_text(picture, text, {at_right ? picture.cols - extent.width - 12 : 12, picture.rows / 2}, size);
}

}  // namespace

void write_picture(const fs::path& file, const cv::Mat& picture) {
  const std::vector<unsigned char> bytes = encode_png(picture);
  write_whole_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

VideoFile::VideoFile(fs::path file, double frames_per_s) : file_(std::move(file)), rate_hz_(frames_per_s) {}

VideoFile::~VideoFile() = default;

void VideoFile::add(const cv::Mat& picture) {
  if (!writer_) {
    auto writer = picture_codecs().write_film(file_.path().string(), rate_hz_, picture.size());
    if (!writer->isOpened()) require_writable(file_.path());  // a full disk: said as for other files
    if (!writer->isOpened())
      throw MachineError(fmt::format("{}: OpenCV's FFmpeg offers no H.264 encoder", file_.path().string()));
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
  require_writable(file_.path());
  const auto reader = picture_codecs().read_film(file_.path().string());
  if (!reader->isOpened() || static_cast<int>(reader->get(cv::CAP_PROP_FRAME_COUNT)) != picture_count_) {
    throw MachineError(fmt::format("{}: what was written does not read back whole", file_.path().string()));
  }
  file_.keep();
}

void write_caption(cv::Mat& picture, const std::string& text) {
  constexpr double largest = 0.8;
  int baseline = 0;
  const cv::Size extent = cv::getTextSize(text, cv::FONT_HERSHEY_DUPLEX, 1, 2, &baseline);
  const double size = std::min(largest, static_cast<double>(picture.cols - 24) / std::max(1, extent.width));
  write_text(picture, text, {12, picture.rows - 9}, size);
}

void mark_place(cv::Mat& picture, double u_px, double v_px) {
  const cv::Point place(static_cast<int>(u_px), static_cast<int>(v_px));
  cv::drawMarker(picture, place, yellow, cv::MARKER_TILTED_CROSS, 22, 2, cv::LINE_AA);
  cv::circle(picture, place, 18, yellow, 2, cv::LINE_AA);
}

cv::Mat draw_overlay(const OverlayMoment& moment, const StereoRig& rig, int scale) {
  cv::Mat picture;
  cv::resize(moment.left, picture, cv::Size(), scale, scale, cv::INTER_NEAREST);
  cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  const Eigen::Isometry3d T_camera_world = moment.T_world_camera.inverse();
  // Nothing where the point is too near, or behind.
  const auto pixel_of = [&](const Eigen::Vector3d& position_world) -> std::optional<cv::Point> {
    const Eigen::Vector3d seen = T_camera_world * position_world;
    if (seen.z() < nearest_drawn_m) return std::nullopt;
    const double u = rig.focal_px * seen.x() / seen.z() + rig.center_left_x_px;
    const double v = rig.focal_px * seen.y() / seen.z() + rig.center_y_px;
    return cv::Point(static_cast<int>((u + 0.5) * scale), static_cast<int>((v + 0.5) * scale));
  };
  for (const ObstaclePoint& point : moment.remembered) {
    const auto place = pixel_of(point.position_world);
    if (place && place->inside(cv::Rect(0, 0, picture.cols, picture.rows)))
      cv::circle(picture, *place, scale + 1, red, cv::FILLED, cv::LINE_AA);
  }
  std::optional<cv::Point> before;
  for (const Eigen::Vector3d& position_world : moment.way_world) {
    const auto place = pixel_of(position_world);
    if (before && place) cv::line(picture, *before, *place, green, 2, cv::LINE_AA);
    before = place;
  }
  for (const StereoHit& hit : moment.hits) {
    const cv::Rect box(hit.column_px * scale, hit.row_px * scale, 5 * scale, 5 * scale);
    cv::rectangle(picture, box, blue, scale > 1 ? 2 : 1);
  }
  if (moment.airspeed_mps)
    write_at_side(picture, fmt::format("{:.0f} mph", *moment.airspeed_mps * mph_per_mps), false);
  if (moment.altitude_m)
    write_at_side(picture, fmt::format("{:.0f} ft", *moment.altitude_m * feet_per_m), true);
  if (!moment.caption.empty()) write_text(picture, moment.caption, {12, picture.rows - 12}, 0.5);
  return picture;
}

}  // namespace understory
