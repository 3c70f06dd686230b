#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <string>

#include "estimation/samples.hpp"
#include "estimation/state.hpp"
#include "perception/stereo_frame.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/recording/euroc_texts.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/cameras/stereo_cameras.hpp"

namespace understory {

/// Records images, IMU samples and the truth in the EuRoC/ASL layout: <folder>/mav0 (docs/record.md). Images
/// are written as they come, the tables by finish().
class EurocRecording : public FlightObserver {
 public:
  /// `folder`: an OutputFolder's. `expected_s`: how much of simulated time is to come; that many images must
  /// fit the disk. Throws ScenarioError where the course has more obstacles than 16 bits can number,
  /// MachineError where the disk is too full.
  EurocRecording(const std::filesystem::path& folder, const Scenario& scenario, const CalibratedRig& rig,
                 double expected_s);
  EurocRecording(const EurocRecording&) = delete;
  EurocRecording& operator=(const EurocRecording&) = delete;

  // For a flight:
  bool needs_images() const override { return true; }
  void on_frame(const Flight& flight) override;
  void on_step(const Flight& flight) override;

  // For cameras that are carried:
  /// To be called at every physics step, before its images.
  void observe(const Truth& truth);
  void add(const ImuSample& sample);
  /// To be called within a second of the frame's time. `cameras`, which took it, draw the true depth and the
  /// objects. Throws MachineError where the disk is full.
  void add(const StereoFrame& frame, const StereoCameras& cameras);

  /// Throws ScenarioError where there is no frame.
  void finish();

  std::int64_t frames() const { return frames_; }

 private:
  void add_sensors(const Flight& flight);
  void require_room() const;
  Truth truth_at(std::int64_t t_ns) const;
  void add_true_state(const Truth& truth);
  void add_estimate(const State& state);

  std::filesystem::path folder_;
  StereoRig rig_;
  std::int64_t truth_every_steps_;
  Eigen::Vector3d gyro_bias_radps_, accelerometer_bias_mps2_;
  std::deque<Truth> recent_;
  std::int64_t steps_ = 0;
  std::int64_t frames_ = 0;
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
