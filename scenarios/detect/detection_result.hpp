#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "perception/stereo_rig.hpp"

namespace understory {

/// What was done with one frame. Times are wall time, measured for people.
struct FrameRecord {
  std::int64_t t_ns = 0;
  std::int64_t hits = 0;
  double rectify_ms = 0;  ///< 0 where images come rectified
  double detect_ms = 0;
  bool in_map = false;  ///< a pose covers its time
};

/// A recording's detections in numbers.
struct DetectionResult {
  StereoRig rig;
  bool rectified_here = false;  ///< images came raw
  struct Depth {
    double depth_m = 0;  ///< of the whole disparity looked at
    int disparity_px = 0;
    DepthInterval one_pixel;
  };
  std::vector<Depth> depths;
  int last_row_px = 0;
  std::vector<FrameRecord> frames;
  std::int64_t frames_expected = 0;  ///< said by the input; a video's container may say too many
  std::int64_t unpaired_images = 0;
  std::optional<std::int64_t> remembered_points;  ///< where there were poses
  std::string files;                              ///< what was written
};

/// frame,t_ns,hits,rectify_ms,detect_ms,in_map: a line per frame.
std::string frames_to_csv(const std::vector<FrameRecord>& frames);

/// One screen for a person.
std::string to_report(const DetectionResult& result);

}  // namespace understory
