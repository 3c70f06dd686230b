#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "perception/rectification/rectify.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {

struct DetectionOptions {
  std::vector<std::filesystem::path> inputs;  ///< as StereoRecording takes them
  std::filesystem::path rig;       ///< as read_calibrated_rig takes it; empty: the EuRoC input's own
  CalibrationOptions calibration;  ///< the images' size is added
  Interpolation interpolation = Interpolation::nearest;  ///< of raw images, as in flight
  VisionConfigSources vision;
  std::filesystem::path poses;  ///< empty: no map
  std::filesystem::path output_folder = "detections";
  bool video = false;  ///< one film instead of a picture per frame
  std::function<void(std::int64_t frames, std::int64_t expected, std::int64_t hits)> on_progress;
};

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
  std::string detector;         ///< value of perception.detector
  bool rectified_here = false;  ///< images came raw
  struct Depth {
    double depth_m = 0;  ///< of the whole disparity looked at
    int disparity_px = 0;
    DepthInterval one_pixel;
  };
  std::vector<Depth> depths;
  int last_row_px = 0;
  std::vector<FrameRecord> frames;
  std::int64_t frames_expected = 0;  ///< stated by the input; a video's container may state too many
  std::int64_t unpaired_images = 0;
  std::optional<std::int64_t> remembered_points;  ///< where there were poses
  std::string files;                              ///< what was written
};

/// Runs the flight's detector over a recording and writes into the output folder: points.csv and points.ply
/// (hits_to_csv, hits_to_ply), timings.csv (frame,t_ns,hits,rectify_ms,detect_ms,in_map), overlays/000000.png
/// ... or overlay.mp4, and with poses map.ply (points_to_ply: every point ever remembered). Files of an
/// earlier run with these names are removed first; every file appears whole or not at all. Throws
/// ScenarioError in one line at input that does not fit, MachineError where the disk is full.
DetectionResult run_detection(const DetectionOptions& options);

/// One screen for a person.
std::string to_report(const DetectionResult& result);

}  // namespace understory
