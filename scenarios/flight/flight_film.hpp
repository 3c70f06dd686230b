#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "perception/rectification/rectify.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/flight/flight_log.hpp"
#include "scenarios/report/pictures.hpp"

namespace understory {

/// flight.mp4: the left camera's image with the paper's overlay and the plan beside a chase view of half the
/// sharpness, words in a strip below, in real time, 30 pictures a second. The last half second of a lost
/// flight shows every frame, four times slower, and the last picture stays for a second, the impact marked.
/// still.png: the picture with the most detections.
class FlightFilm : public FlightObserver {
 public:
  /// Files go into `folder`. `frame_rate_hz`: of the frames that reach the autopilot. `log`: of the same
  /// flight, kept by an observer that is called earlier.
  FlightFilm(const std::filesystem::path& folder, double frame_rate_hz, const FlightLog& log);

  bool needs_images() const override { return true; }
  const char* stage() const override { return "film"; }
  void on_frame(const Flight& flight) override;
  void finish(const Flight& flight);

  const std::vector<float>& times_s() const { return times_s_; }  ///< of each picture, simulated
  const cv::Mat& last() const { return last_; }                   ///< picture; empty without any

 private:
  /// What a picture needs, kept until it is known whether the flight ends soon after.
  struct Moment {
    std::int64_t number = 0;  ///< of the frame
    StereoFrame frame;
    OverlayMoment overlay;
    Truth truth;
    std::array<std::string, 2> captions;  ///< below the left picture and the right one
  };
  Moment moment_of(const Flight& flight);
  cv::Mat draw(const Flight& flight, Moment& moment);
  void add(const Flight& flight, Moment& moment);

  std::filesystem::path folder_;
  const FlightLog& log_;
  int every_;  ///< frames per picture
  VideoFile video_;
  std::optional<Rectifier> rectifier_;  ///< for raw pairs, since the detector rectifies only part of an image
  std::deque<Moment> recent_;
  std::int64_t frames_ = 0;
  std::vector<float> times_s_;
  std::size_t maximum_hits_ = 0;
  cv::Mat still_, last_;
};

}  // namespace understory
