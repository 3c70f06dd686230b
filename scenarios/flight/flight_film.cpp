#include "scenarios/flight/flight_film.hpp"

#include <algorithm>

#include "scenarios/report/overlay.hpp"

namespace understory {
namespace {
constexpr int scale = 2;
}

FlightFilm::FlightFilm(const std::filesystem::path& folder, const StereoRig& rig, StereoCameras& cameras,
                       double frame_rate_hz)
    : folder_(folder),
      rig_(rig),
      cameras_(cameras),
      video_(folder / "flight.mp4", frame_rate_hz / std::max(1, static_cast<int>(frame_rate_hz / 30))),
      every_(std::max(1, static_cast<int>(frame_rate_hz / 30))) {}

void FlightFilm::observe(const StereoFrame& frame, const Autopilot& autopilot,
                         const StateSource& state_source, const mjData& data) {
  if (frames_++ % every_ != 0) return;
  const State seen = state_source.state_at(frame.t_ns);
  const OverlayMoment moment{frame.left,
                             autopilot.hits(),
                             autopilot.map().points(),
                             seen.T_world_body * rig_.T_body_camera,
                             seen.velocity_body_mps.x(),
                             seen.T_world_body.translation().z(),
                             ""};
  const cv::Mat eye = draw_overlay(moment, rig_, scale);
  const cv::Mat picture = beside(eye, cameras_.chase_view(data, eye.cols, eye.rows));
  video_.add(picture);
  if (still_.empty() || moment.hits.size() > maximum_hits_) {
    still_ = picture.clone();
    maximum_hits_ = moment.hits.size();
  }
}

void FlightFilm::finish() {
  video_.finish();
  if (!still_.empty()) write_png(folder_ / "still.png", still_);
}

}  // namespace understory
