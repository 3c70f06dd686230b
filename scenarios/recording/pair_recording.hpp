#pragma once

#include <filesystem>
#include <string>

#include "perception/stereo_calibration.hpp"
#include "scenarios/recording/recording.hpp"

namespace understory {

/// Records rectified stereo pairs with true disparities (docs/record.md lists files, units and frames):
/// - KITTI (stereo 2012): training/image_0, image_1, disp_occ, disp_noc, calib; poses.txt and times.txt as
/// its
///   odometry has them;
/// - Middlebury (2014; ETH3D's, too): a folder for each pair with im0.png, im1.png, disp0.pfm, mask0nocc.png,
///   calib.txt; the same poses and times.
class PairRecording : public Recording {
 public:
  /// `folder`: an OutputFolder's. Throws ScenarioError where images come raw, and, for KITTI, whose 16 bits
  /// hold none, where disparities can be negative.
  PairRecording(const std::filesystem::path& folder, const CalibratedRig& rig, const RecordingChoice& choice);

  void finish() override;

 private:
  void add_frame(const StereoFrame& frame, const Truth& truth, const TrueView& view) override;

  std::filesystem::path folder_;
  StereoRig rig_;
  RecordingForm form_;
  std::optional<Eigen::Isometry3d> T_first_world_;
  std::string poses_, times_;
};

}  // namespace understory
