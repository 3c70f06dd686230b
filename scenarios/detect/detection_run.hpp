#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "perception/io/calibration_file.hpp"
#include "perception/map/local_map.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "perception/rectify.hpp"
#include "scenarios/detect/detection_result.hpp"

namespace understory {

/// The numbers of a detection run. In --set: depths_m, pushbroom.minimum_edge_sum, map.max_age_s ...
struct DetectionConfig {
  PushbroomConfig pushbroom = robust_rule();
  LocalMapConfig map;
};

template <typename Visitor>
void visit_fields(Visitor& visit, DetectionConfig& config) {
  visit("depths_m", config.pushbroom.depths_m, 0.1, 1000.0);  // to look at; empty: the rig's own
  visit("pushbroom", config.pushbroom);
  visit("map", config.map);
}

/// Where a run stands.
struct DetectionProgress {
  std::int64_t frames = 0;
  std::int64_t frames_expected = 0;
  std::int64_t hits = 0;
  double wall_s = 0;
};

struct DetectionOptions {
  std::vector<std::filesystem::path> inputs;  ///< as StereoRecording takes them
  std::filesystem::path rig;       ///< as read_calibrated_rig takes it; empty: the EuRoC input's own
  CalibrationOptions calibration;  ///< sizes left open here are the images'
  Interpolation interpolation = Interpolation::nearest;  ///< of raw images, as in flight
  /// The rule; its last row, said for images of 240 rows as the paper's are, is taken in proportion.
  PushbroomConfig rule = robust_rule();
  std::vector<std::string> settings;  ///< "key=value" of DetectionConfig, last of all
  std::filesystem::path poses;        ///< empty: no map
  std::filesystem::path output_folder = "detections";
  bool video = false;  ///< one film instead of a picture per frame
  std::function<void(const DetectionProgress&)> on_progress;
};

/// Runs the flight's detector over a recording and writes into the output folder: points.csv and points.ply
/// (hits_to_csv, hits_to_ply), timings.csv (frames_to_csv), overlays/000000.png ... or overlay.mp4, and with
/// poses map.ply (points_to_ply: every point ever remembered). What an earlier run left there under these
/// names goes first; every file appears whole or not at all. Throws ScenarioError in one line at input that
/// does not fit, MachineError where the disk is full.
DetectionResult run_detection(const DetectionOptions& options);

}  // namespace understory
