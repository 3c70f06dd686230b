#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "perception/obstacle_point.hpp"
#include "perception/stereo_hit.hpp"
#include "perception/stereo_rig.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/signals.hpp"

namespace cv {
class VideoWriter;
}

namespace understory {

/// A picture as a PNG file, whole or not at all: 8- or 16-bit gray or 8-bit BGR.
void write_picture(const std::filesystem::path& file, const cv::Mat& picture);

/// H.264 in mp4, which browsers play, in an UnfinishedFolder. Removed if finish() is not reached.
class VideoFile {
 public:
  VideoFile(std::filesystem::path file, double frames_per_s);
  ~VideoFile();
  /// BGR 8-bit, every picture of the size of the first (even width and height). Throws MachineError where no
  /// H.264 encoder is installed, ScenarioError where the file cannot be made.
  void add(const cv::Mat& picture);
  /// Throws MachineError where the disk filled up or the file does not read back.
  void finish();

 private:
  Unfinished file_;
  double rate_hz_;
  int picture_count_ = 0;
  std::unique_ptr<cv::VideoWriter> writer_;  ///< from the first picture on
};

/// What one picture of the overlay shows.
struct OverlayMoment {
  cv::Mat left;                 ///< CV_8UC1, the rig's size
  std::vector<StereoHit> hits;  ///< of this very frame
  std::vector<ObstaclePoint> remembered;
  std::vector<Eigen::Vector3d> way_world;  ///< of the plan in force
  /// By the estimate, at the image's moment.
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  std::optional<double> airspeed_mps;  ///< written where known
  std::optional<double> altitude_m;    ///< written where known
  std::string caption;                 ///< along the lower edge
};

/// The paper's overlay (Barry & Tedrake 2015), `scale` times as large: blue boxes for this frame's
/// detections, red dots for remembered points reprojected by the estimate, airspeed in mph at the left,
/// altitude in feet at the right; the plan is a green line. BGR 8-bit.
cv::Mat draw_overlay(const OverlayMoment& moment, const StereoRig& rig, int scale);

/// Writes along the lower edge, as large as the picture's width allows, to be legible at half the picture's
/// size.
void write_caption(cv::Mat& picture, const std::string& text);

/// A cross in a ring, for what went wrong there.
void mark_place(cv::Mat& picture, double u_px, double v_px);

}  // namespace understory
