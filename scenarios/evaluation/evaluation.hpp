#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/evaluation/disparity_files.hpp"
#include "scenarios/evaluation/obstacle_sightings.hpp"
#include "scenarios/evaluation/published_evaluations.hpp"
#include "scenarios/evaluation/vision_tally.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {

/// One that is computed: the algorithm's name, its part and keys.
struct ComparedDetector {
  std::string name, part;
  VisionConfig config;
};

/// A detector with several values of one of its keys, from lax to strict: a curve of precision over recall.
struct CurveSettings {
  std::string detector;   ///< a part's name
  std::string threshold;  ///< the key that is varied, without "perception.NAME."
  std::vector<std::pair<double, VisionConfig>> points;
};

/// What is evaluated, and how: `pushbroom` is the detector's parameter set, `map` the one of the evaluations
/// with memory, `compute` the aircraft's computer, for results at its own pace, even if not `enabled`.
struct EvaluationSettings : VisionConfig {
  int every = 1;                                      ///< every n-th frame only
  std::vector<ComparedDetector> more_detectors = {};  ///< further ones
  std::vector<DisparityFolder> disparities = {};      ///< of other programs
  std::vector<CurveSettings> curves = {};             ///< besides those of the algorithms below
};

/// The algorithms that every evaluation has; the first four have to be computed, and so have those that
/// follow all six: the settings' detectors, then their disparities. All look at the same depths, except
/// detectors of plug-ins, which choose their own.
namespace algorithm {
enum Index : std::size_t { our_rule, the_papers_rule, stereo_bm, stereo_sgbm, true_depth, at_random };
}
inline constexpr std::size_t algorithm_count = 6, computed_count = 4;
inline constexpr std::array<const char*, algorithm_count> algorithm_names{
    "pushbroom", "pushbroom, original", "StereoBM", "StereoSGBM", "true depth", "random"};

/// The first four algorithms and the settings' detectors, in their order; full stereo is cropped to what the
/// pushbroom looks at.
std::vector<ComparedDetector> compared_detectors(const EvaluationSettings& settings, const StereoRig& rig);

/// Those that go through the paper's own evaluations.
inline constexpr std::array<algorithm::Index, 3> published_algorithms{
    algorithm::our_rule, algorithm::the_papers_rule, algorithm::at_random};

/// The depths at which full stereo is compared with a rule: those of one pixel of disparity, the rule's rows.
FullStereoCrop crop_beside(const PerceptionSection& perception, const StereoRig& rig);

/// Settings of one algorithm's threshold from lax to strict, at one pixel, over all frames.
struct PrecisionRecallCurve {
  struct Point {
    double threshold = 0;
    Rates rates = {};
  };
  std::string algorithm;
  std::string threshold;  ///< what is varied
  std::vector<Point> points = {};
};

/// A parameter set with its invariance filter off and on (the paper's figure), at one pixel.
struct InvarianceRow {
  std::string parameters;
  bool filter = false;
  std::int64_t hits = 0;
  Rates rates = {};  ///< empty if there is no true depth
};

/// The results of one recording, or of some of them together.
struct EvaluationSum {
  std::string name;  ///< of the scene; "all"
  std::int64_t frames = 0, recordings = 0;
  double seconds = 0;
  std::vector<std::string> algorithms;  ///< names; what follows has a place for each
  std::vector<VisionTally> tallies;
  std::vector<std::vector<ObstacleSighting>> sightings;
  std::vector<std::int64_t> hits;
  std::vector<PacedResult> paced;            ///< of those that are computed
  std::vector<std::vector<double>> cost_ms;  ///< per frame, on one thread of this machine; of those, too
  std::vector<DisparityErrors> disparities;  ///< of those that match every pixel
  std::array<PublishedScores, published_algorithms.size()> published;
  std::vector<InvarianceRow> invariance;
  /// Without true depth: with StereoBM's and StereoSGBM's depths in its place, at one pixel.
  std::array<std::vector<Rates>, 2> agreement;
  std::vector<PrecisionRecallCurve> curves;

  /// Places for all algorithms of the settings, with nothing in them.
  void make_room(const EvaluationSettings& settings);
  void add(const EvaluationSum& other);
};

/// Whether the algorithm with this index has to be computed.
constexpr bool is_computed(std::size_t algorithm) {
  return algorithm < computed_count || algorithm >= algorithm_count;
}

/// The algorithms whose faults are shown one by one: our rule, and those that the settings add.
std::vector<std::size_t> followed(const EvaluationSum& sum);

/// A frame with many false positives, to be shown.
struct WorstFrame {
  std::size_t index = 0;  ///< of the recording
  int false_hits = 0;
  std::vector<StereoHit> hits = {};  ///< all of them
};

/// All results of one recording.
struct RecordingEvaluation {
  std::filesystem::path folder;
  StereoRig rig;
  DetectionDepth detection_depth;  ///< the first depth
  bool has_depth = false, has_objects = false, has_poses = false;
  std::vector<RecordedObject> objects;
  EvaluationSum sum;  ///< named as the folder without its seed: recordings of one scene add up
  std::vector<std::vector<WorstFrame>> worst;  ///< of each of followed(); the first is the worst
};

/// What a recording is called: its folder, "rec" of "/data/rec/".
std::string recording_name(const std::filesystem::path& folder);
/// "level-1203" is of the scene "level": what stands behind the last hyphen is a seed, where it is a number.
std::string scene_of(const std::filesystem::path& folder);

/// Throws ScenarioError as EvaluationRecording does, or where the rule does not fit the rig. `on_frame` is
/// called after each.
RecordingEvaluation evaluate_recording(const std::filesystem::path& folder,
                                       const EvaluationSettings& settings,
                                       const std::function<void()>& on_frame);

struct EvaluationOptions {
  std::vector<std::filesystem::path> folders;  ///< recordings of one rig
  EvaluationSettings settings;
  int jobs = 1;  ///< recordings at once; figures do not depend on it, costs do a little
  /// Called after each frame, from one thread at a time.
  std::function<void(std::int64_t frames, std::int64_t expected)> on_progress;
};

struct Evaluation {
  EvaluationSettings settings;
  std::vector<RecordingEvaluation> recordings;  ///< in the folders' order
  EvaluationSum all;
  std::vector<EvaluationSum> scenes;                               ///< in order of first appearance
  bool has_depth = false, has_objects = false, has_poses = false;  ///< any of the recordings
};

/// Calls work(0) .. work(count - 1), up to `threads` (>= 1) at once, in any order. Throws what the first
/// failure threw; nothing begins after it.
void in_parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

/// Throws ScenarioError, one line, where a folder cannot be read, is given twice, or recordings are of
/// different rigs; where two algorithms have one name; where disparities of several recordings do not lie in
/// a folder for each.
Evaluation evaluate(const EvaluationOptions& options);

}  // namespace understory
