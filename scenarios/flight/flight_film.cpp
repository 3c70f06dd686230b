#include "scenarios/flight/flight_film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace understory {
namespace {

constexpr std::int64_t slow_end_ns = 500'000'000;
constexpr double film_rate_hz = 30;

/// Of the moment of an exposure, under the plan in force when the frame arrived.
std::array<std::string, 2> captions_of(const FlightLog& log, std::int64_t t_ns) {
  const LogMoment& moment = moment_at(log, t_ns);
  const LogPlan* plan = log.plans.empty() ? nullptr : &log.plans.back();
  const std::string planned =
      plan == nullptr ? "none"
      : std::isfinite(plan->clearance_m)
          ? fmt::format("{}, {:.2f} m clear", word_for(plan->origin), plan->clearance_m)
          : fmt::format("{}, nothing near", word_for(plan->origin));
  return {fmt::format("{:.2f} s   {:.1f} m/s   {:.1f} m high", seconds(t_ns),
                      moment.velocity_world_mps.norm(), moment.T_world_body.translation().z()),
          "plan: " + planned};
}

void mark(cv::Mat picture, const Eye& eye, const Eigen::Vector3d& place_world, int scale) {
  const Eigen::Vector3d seen = eye.T_world_camera.inverse() * place_world;
  if (seen.z() < near_m) return;
  mark_place(picture, scale * (eye.focal_px * seen.x() / seen.z() + eye.center_x_px),
             scale * (eye.focal_px * seen.y() / seen.z() + eye.center_y_px));
}

constexpr int scale = 2, caption_px = 32;

}  // namespace

FlightFilm::FlightFilm(const std::filesystem::path& folder, double frame_rate_hz, const FlightLog& log)
    : folder_(folder),
      log_(log),
      every_(std::max(1, static_cast<int>(frame_rate_hz / film_rate_hz))),
      video_(folder / "flight.mp4", frame_rate_hz / every_) {}

FlightFilm::Moment FlightFilm::moment_of(const Flight& flight) {
  const StereoFrame& frame = flight.frame();
  const State seen = flight.state_at(frame.t_ns);
  const Truth& truth = flight.truth_at(frame.t_ns);
  OverlayMoment overlay{{},
                        flight.hits(),
                        flight.map().points(),
                        log_.plans.empty() ? std::vector<Eigen::Vector3d>() : log_.plans.back().way_odometry,
                        seen.T_world_body * flight.rig().rig.T_body_camera,
                        seen.velocity_body_mps.x(),
                        seen.T_world_body.translation().z(),
                        {}};
  return {frames_++, frame, std::move(overlay), truth, captions_of(log_, frame.t_ns)};
}

cv::Mat FlightFilm::draw(const Flight& flight, Moment& moment) {
  const CalibratedRig& rig = flight.rig();
  if (rig.calibration && !rectifier_) rectifier_.emplace(*rig.calibration, Interpolation::nearest);
  moment.overlay.left = rectifier_ ? rectifier_->rectify(moment.frame).left : moment.frame.left;
  const cv::Mat eye = draw_overlay(moment.overlay, rig.rig, scale);
  // At half its size the view from behind is drawn in a quarter of the time, and takes half of a film's
  // bytes.
  cv::Mat chase, pictures, picture;
  cv::resize(flight.cameras()->chase_view(moment.truth, eye.cols / 2, eye.rows / 2), chase, eye.size());
  cv::hconcat(eye, chase, pictures);
  cv::copyMakeBorder(pictures, picture, 0, caption_px, 0, 0, cv::BORDER_CONSTANT);
  for (const int side : {0, 1}) {
    cv::Mat half = picture.colRange(side * eye.cols, (side + 1) * eye.cols);
    write_caption(half, moment.captions[static_cast<std::size_t>(side)]);
  }
  return picture;
}

void FlightFilm::add(const Flight& flight, Moment& moment) {
  last_ = draw(flight, moment);
  video_.add(last_);
  times_s_.push_back(static_cast<float>(seconds(moment.frame.t_ns)));
  if (still_.empty() || moment.overlay.hits.size() > maximum_hits_) {
    still_ = last_;
    maximum_hits_ = moment.overlay.hits.size();
  }
}

void FlightFilm::on_frame(const Flight& flight) {
  recent_.push_back(moment_of(flight));
  while (recent_.back().frame.t_ns - recent_.front().frame.t_ns > slow_end_ns) {
    if (recent_.front().number % every_ == 0) add(flight, recent_.front());
    recent_.pop_front();
  }
}

void FlightFilm::finish(const Flight& flight) {
  const bool is_lost = flight.outcome() != Outcome::goal;
  for (Moment& moment : recent_)
    if (is_lost || moment.number % every_ == 0) add(flight, moment);
  if (is_lost && !recent_.empty()) {
    Moment& end = recent_.back();
    end.truth = flight.truth();  // a little after the last frame
    end.captions = {fmt::format("{:.2f} s", flight.clock().t_s()), std::string(word_for(*flight.outcome()))};
    last_ = draw(flight, end);
    const Touch touch = flight.touch();
    if (touch.with != Contact::none) {
      const int width_px = last_.cols / 2, height_px = last_.rows - caption_px;
      const Eye left = eyes_of(flight.rig().rig, end.truth.T_world_body)[0];
      mark(last_.colRange(0, width_px), left, touch.position_world, scale);
      mark(last_.colRange(width_px, last_.cols), chase_eye(end.truth.T_world_body, width_px, height_px),
           touch.position_world, 1);
    }
    for (int i = 0; i < film_rate_hz; ++i) {
      video_.add(last_);
      times_s_.push_back(static_cast<float>(flight.clock().t_s()));
    }
  }
  recent_.clear();
  video_.finish();
  if (!still_.empty()) write_picture(folder_ / "still.png", still_);
}

}  // namespace understory
