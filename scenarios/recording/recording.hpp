#pragma once

#include <deque>
#include <filesystem>
#include <memory>

#include "estimation/samples.hpp"
#include "perception/stereo_frame.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/recording/recording_choice.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/cameras/stereo_cameras.hpp"

namespace understory {

/// What a flight, or cameras that are carried, leave as a data set.
class Recording : public FlightObserver {
 public:
  explicit Recording(int every) : every_(every) {}
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  // For a flight:
  bool needs_images() const override { return true; }
  void on_frame(const Flight& flight) override;
  void on_step(const Flight& flight) override { observe(flight.truth()); }

  // For cameras that are carried:
  /// To be called at every physics step, before its images.
  void observe(const Truth& truth);
  virtual void add(const ImuSample&) {}
  /// To be called within a second of the frame's time. `cameras`, which took it, draw the true depth and the
  /// objects. Throws MachineError where the disk is full.
  void add(const StereoFrame& frame, const StereoCameras& cameras);

  /// Writes the tables. Throws ScenarioError where there is no frame.
  virtual void finish() = 0;

  std::int64_t frames() const { return frames_; }

 protected:
  virtual void add_step(const Truth&) {}
  /// `truth`: at the frame's time.
  virtual void add_frame(const StereoFrame& frame, const Truth& truth, const TrueView& view) = 0;
  void require_frames(const std::filesystem::path& folder) const;

 private:
  Truth truth_at(std::int64_t t_ns) const;

  int every_;
  std::int64_t seen_ = 0, frames_ = 0;
  std::deque<Truth> recent_;
};

/// `folder`: an OutputFolder's. `expected_s`: how much of simulated time is to come; that many images must
/// fit the disk. Throws as the recordings do.
std::unique_ptr<Recording> recording_of(const RecordingChoice& choice, const std::filesystem::path& folder,
                                        const Scenario& scenario, const CalibratedRig& rig,
                                        double expected_s);

}  // namespace understory
