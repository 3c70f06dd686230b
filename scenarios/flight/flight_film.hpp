#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "perception/rectification/rectify.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/report/pictures.hpp"

namespace understory {

/// flight.mp4: the left camera's image with the paper's overlay beside a chase view, in real time, 30
/// pictures a second. still.png: the picture with the most detections.
class FlightFilm : public FlightObserver {
 public:
  /// Files go into `folder`. `frame_rate_hz`: of the frames that reach the autopilot.
  FlightFilm(const std::filesystem::path& folder, double frame_rate_hz);

  bool needs_images() const override { return true; }
  const char* stage() const override { return "film"; }
  void on_frame(const Flight& flight) override;
  void finish();

 private:
  std::filesystem::path folder_;
  int every_;  ///< frames per picture
  VideoFile video_;
  std::optional<Rectifier> rectifier_;  ///< for raw pairs, since the detector rectifies only part of an image
  std::int64_t frames_ = 0;
  std::size_t maximum_hits_ = 0;
  cv::Mat still_;
};

}  // namespace understory
