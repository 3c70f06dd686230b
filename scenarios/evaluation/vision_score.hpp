#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "perception/map/local_map.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "scenarios/evaluation/evaluation_recording.hpp"
#include "scenarios/evaluation/obstacle_sightings.hpp"
#include "scenarios/evaluation/share.hpp"

namespace understory {

/// Counts of one detector over one recording; shares are at one pixel.
struct RecordingScore {
  std::string name;
  std::int64_t frames = 0;
  Share precision, recall;
  Share trunks_1m,
      trunks_3m;  ///< passed within 1 m, 3 m, in view at the depth: found by three true positives
};

/// Figures of one configuration over all of them.
struct VisionScore {
  std::vector<RecordingScore> recordings;  ///< in the folders' order: what a bootstrap draws from
  double precision = 0, recall = 0, f_score = 0, hits_per_frame = 0, trunks_1m = 0, trunks_3m = 0;
};

/// The sums over the recordings as shares.
VisionScore summed(std::vector<RecordingScore> recordings);

/// Recorded pairs and their truth, held in memory, for thousands of configurations (0.55 MB a frame).
class VisionData {
 public:
  /// Takes every `every`-th frame. Throws ScenarioError where a folder cannot be read, has no true depth, or
  /// another rig than the first.
  VisionData(const std::vector<std::filesystem::path>& folders, int every = 1);

  /// The rule over all frames. Safe to call from several threads at once.
  VisionScore score(const PushbroomConfig& rule) const;

  const StereoRig& rig() const { return rig_; }
  std::size_t frame_count() const;

 private:
  struct Recording {
    std::string name;
    std::vector<RecordedObject> objects;
    std::vector<EvaluationFrame> frames;
    std::vector<std::vector<ExpectedBlock>> expected;  ///< of each frame, at usual_
  };
  RecordingScore score(const Recording& recording, const PushbroomConfig& rule) const;

  StereoRig rig_;
  PushbroomConfig usual_;  ///< rules that look where this one does find the blocks due computed already
  std::vector<Recording> recordings_;
};

}  // namespace understory
