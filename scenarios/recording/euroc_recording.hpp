#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "estimation/state.hpp"
#include "scenarios/recording/euroc_texts.hpp"
#include "scenarios/recording/recording.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace understory {

/// Records images, IMU samples and the truth in the EuRoC/ASL layout: <folder>/mav0 (docs/record.md). Images
/// are written as they come, the tables by finish().
class EurocRecording : public Recording {
 public:
  /// `folder`: an OutputFolder's. `expected_s`: how much of simulated time is to come; that many images must
  /// fit the disk. Throws ScenarioError where the course has more obstacles than 16 bits can number,
  /// MachineError where the disk is too full.
  EurocRecording(const std::filesystem::path& folder, const Scenario& scenario, const CalibratedRig& rig,
                 double expected_s, int every = 1);

  void on_step(const Flight& flight) override;
  void add(const ImuSample& sample) override;
  using Recording::add;
  void finish() override;

 private:
  void add_step(const Truth& truth) override;
  void add_frame(const StereoFrame& frame, const Truth& truth, const TrueView& view) override;
  void add_sensors(const Flight& flight);
  void require_room(std::int64_t frames) const;
  void add_true_state(const Truth& truth);
  void add_estimate(const State& state);

  std::filesystem::path folder_;
  StereoRig rig_;
  std::int64_t truth_every_steps_;
  Eigen::Vector3d gyro_bias_radps_, accelerometer_bias_mps2_;
  std::int64_t steps_ = 0;
  double expected_frames_;
  std::uintmax_t bytes_ = 0;  ///< of the images so far, on the disk
  std::string image_lines_, imu_lines_;
  std::map<std::string, std::string> sensor_lines_;              ///< of a flight's further tables, by folder
  std::map<std::string, std::int64_t> newest_ns_;                ///< of their samples
  std::map<std::int64_t, std::string> true_states_, estimates_;  ///< by time: frames come late
};

/// Depth in metres (CV_32FC1) as 16-bit millimetres; 0 where there is nothing within 65.535 m.
cv::Mat depth_in_millimetres(const cv::Mat& depth_m);

}  // namespace understory
