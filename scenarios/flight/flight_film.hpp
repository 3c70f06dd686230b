#pragma once

#include <filesystem>

#include "planning/autopilot.hpp"
#include "scenarios/report/video_writer.hpp"
#include "sim/cameras/stereo_cameras.hpp"

namespace understory {

/// flight.mp4: what the left camera sees under the paper's overlay, beside a chase view; and still.png, the
/// moment with the most detections. Shows the flight at its own speed, 30 pictures a second. Keeps
/// references.
class FlightFilm {
 public:
  FlightFilm(const std::filesystem::path& folder, const StereoRig& rig, StereoCameras& cameras,
             double frame_rate_hz);

  /// Each frame as the autopilot has just digested it.
  void observe(const StereoFrame& frame, const Autopilot& autopilot, const StateSource& state_source,
               const mjData& data);
  void finish();

 private:
  std::filesystem::path folder_;
  StereoRig rig_;
  StereoCameras& cameras_;
  VideoFile video_;
  int every_ = 4;  ///< frames per picture
  std::int64_t frames_ = 0;
  std::size_t maximum_hits_ = 0;
  cv::Mat still_;
};

}  // namespace understory
