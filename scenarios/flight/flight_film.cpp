#include "scenarios/flight/flight_film.hpp"

#include <algorithm>
#include <opencv2/core.hpp>

#include "scenarios/flight/flight.hpp"
#include "scenarios/report/pictures.hpp"

namespace understory {

FlightFilm::FlightFilm(const std::filesystem::path& folder, double frame_rate_hz)
    : folder_(folder),
      every_(std::max(1, static_cast<int>(frame_rate_hz / 30))),
      video_(folder / "flight.mp4", frame_rate_hz / every_) {}

void FlightFilm::on_frame(const Flight& flight) {
  if (frames_++ % every_ != 0) return;
  const CalibratedRig& rig = flight.rig();
  StereoFrame frame = flight.frame();
  if (rig.calibration) {
    if (!rectifier_) rectifier_.emplace(*rig.calibration, Interpolation::nearest);
    frame = rectifier_->rectify(frame);
  }
  const State seen = flight.state_at(frame.t_ns);
  const OverlayMoment moment{frame.left,
                             flight.hits(),
                             flight.map().points(),
                             seen.T_world_body * rig.rig.T_body_camera,
                             seen.velocity_body_mps.x(),
                             seen.T_world_body.translation().z(),
                             ""};
  constexpr int scale = 2;
  const cv::Mat eye = draw_overlay(moment, rig.rig, scale);
  cv::Mat picture;
  cv::hconcat(eye, flight.chase_view(eye.cols, eye.rows), picture);
  video_.add(picture);
  if (still_.empty() || moment.hits.size() > maximum_hits_) {
    still_ = picture.clone();
    maximum_hits_ = moment.hits.size();
  }
}

void FlightFilm::finish() {
  video_.finish();
  if (!still_.empty()) write_picture(folder_ / "still.png", still_);
}

}  // namespace understory
