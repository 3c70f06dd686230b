#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/image_sequence.hpp"
#include "perception/io/pose_file.hpp"
#include "perception/rectification/rectify.hpp"
#include "scenarios/evaluation/ground_truth.hpp"

namespace understory {

/// A EuRoC/ASL folder as `understory record` leaves it (docs/record.md), or as other programs do: then
/// without true depth, objects and estimates.
class EvaluationRecording {
 public:
  /// Reads all but the images. Throws ScenarioError, one line that names the file, where something there
  /// cannot be read.
  explicit EvaluationRecording(const std::filesystem::path& folder, const CalibrationOptions& options = {});

  const StereoRig& rig() const { return camera_.rig; }
  bool is_raw() const { return camera_.calibration.has_value(); }
  bool has_depth() const { return has_depth_; }
  bool has_objects() const { return !objects_.empty(); }
  bool has_poses() const { return !true_poses_.empty(); }
  const std::vector<RecordedObject>& objects() const { return objects_; }
  std::size_t frame_count() const { return sequence_.pairs.size(); }
  std::int64_t t_ns(std::size_t index) const { return sequence_.pairs[index].t_ns; }
  double duration_s() const;
  /// The n-th frame. Throws ScenarioError as above.
  EvaluationFrame frame(std::size_t index);

 private:
  std::filesystem::path folder_;  ///< that holds cam0
  CalibratedRig camera_;
  ImageSequence sequence_;
  std::optional<Rectifier> rectifier_;
  std::vector<TimedPose> true_poses_, estimates_;
  std::vector<RecordedObject> objects_;
  std::vector<bool> soft_;  ///< by number
  bool has_depth_ = false;
  int image_depth_ = -1;  ///< 8 or 16 bits, as the first image read
};

/// Whether recordings of both rigs can be evaluated with one configuration.
bool is_same_rig(const StereoRig& one, const StereoRig& other);

/// objects.csv. `name` stands for the file in messages. Throws std::runtime_error "name:line: expected ...".
std::vector<RecordedObject> parse_recorded_objects(const std::string& text, const std::string& name);

}  // namespace understory
