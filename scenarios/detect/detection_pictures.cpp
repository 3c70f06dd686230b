#include "scenarios/detect/detection_pictures.hpp"

#include <fmt/format.h>

#include "scenarios/report/overlay.hpp"

namespace understory {
namespace {

constexpr int narrow_px = 500;  // images below this are drawn at twice their size

/// H.264 wants even sides: the last column or row goes.
cv::Mat of_even_size(const cv::Mat& picture) {
  return picture(cv::Rect(0, 0, picture.cols / 2 * 2, picture.rows / 2 * 2));
}

}  // namespace

DetectionPictures::DetectionPictures(const std::filesystem::path& folder, const StereoRig& rig,
                                     std::string looked_at, double film_rate_hz)
    : rig_(rig), looked_at_(std::move(looked_at)), scale_(rig.width_px < narrow_px ? 2 : 1) {
  if (film_rate_hz > 0)
    film_ = std::make_unique<VideoFile>(folder / "overlay.mp4", film_rate_hz);
  else
    pictures_ = std::make_unique<PictureFolder>(folder / "overlays");
}

void DetectionPictures::add(const cv::Mat& left, const std::vector<StereoHit>& hits, const PosedMap* map) {
  OverlayMoment moment;
  moment.left = left;
  moment.hits = hits;
  if (map != nullptr) {
    moment.remembered = map->points();
    moment.T_world_camera = map->T_world_camera();
  }
  moment.caption = fmt::format("frame {}: {} hits at {}", count_++, hits.size(), looked_at_);
  const cv::Mat picture = draw_overlay(moment, rig_, scale_);
  if (film_)
    film_->add(of_even_size(picture));
  else
    pictures_->add(picture);
}

void DetectionPictures::finish() {
  if (film_)
    film_->finish();
  else
    pictures_->finish();
}

}  // namespace understory
