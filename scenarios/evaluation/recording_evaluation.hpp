#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "perception/full_stereo/full_stereo.hpp"
#include "perception/full_stereo/full_stereo_detector.hpp"
#include "perception/map/local_map.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "scenarios/evaluation/evaluation_recording.hpp"
#include "scenarios/evaluation/obstacle_sightings.hpp"
#include "scenarios/evaluation/paced_sightings.hpp"
#include "scenarios/evaluation/published_evaluations.hpp"
#include "scenarios/evaluation/vision_tally.hpp"

namespace understory {

/// What is evaluated, and against what.
struct EvaluationSettings {
  PushbroomConfig rule = robust_rule();
  LocalMapConfig map;        ///< of the evaluations with memory
  StereoBmConfig stereo_bm;  ///< the paper's
  StereoSgbmConfig stereo_sgbm;
  ComputeConfig compute;  ///< the aircraft's computer, for what it finds at its own pace; `enabled` or not
  int every = 1;          ///< every n-th frame only
};

/// The algorithms of one table, in its order. All look at the same depths.
enum AlgorithmIndex {
  our_rule,
  the_papers_rule,
  stereo_bm,
  stereo_sgbm,
  true_depth,
  random_hits,
  algorithm_count
};
inline constexpr std::array<const char*, algorithm_count> algorithm_names{
    "pushbroom, our rule", "pushbroom, the paper's rule", "StereoBM", "StereoSGBM", "true depth", "random"};
/// Those that a computer has to compute.
inline constexpr std::array<AlgorithmIndex, 4> paced_algorithms{our_rule, the_papers_rule, stereo_bm,
                                                                stereo_sgbm};

/// One setting of a threshold, at one pixel.
struct CurvePoint {
  double threshold = 0;
  Share precision, recall;
};
/// Settings of one algorithm from lax to strict.
struct PrecisionRecallCurve {
  std::string algorithm;
  std::string threshold;  ///< what is varied
  std::vector<CurvePoint> points;
};

/// A rule with its invariance filter off and on (the paper's figure), at one pixel.
struct InvarianceRow {
  std::string rule;
  bool filter = false;
  std::int64_t hits = 0;
  Share precision, recall;  ///< of nothing where there is no true depth
};

/// A frame with many false positives, to be shown.
struct WorstFrame {
  std::size_t index = 0;  ///< of the recording
  int false_hits = 0;
};

/// All that one recording says.
struct RecordingEvaluation {
  std::filesystem::path folder;
  std::string scene;  ///< the folder's name without its seed: recordings of one scene add up
  StereoRig rig;
  double detection_depth_m = 0;
  DepthInterval one_pixel;
  std::int64_t frames = 0;
  double seconds = 0;
  bool has_depth = false, has_objects = false, has_poses = false, has_estimates = false;
  std::array<VisionTally, algorithm_count> tallies;
  std::array<std::vector<double>, algorithm_count> cost_ms;  ///< per frame, on one thread of this machine
  std::array<std::int64_t, algorithm_count> hits{};
  std::array<std::vector<ObstacleSighting>, algorithm_count> sightings;
  std::array<PacedResult, paced_algorithms.size()> paced;  ///< of paced_algorithms
  std::vector<RecordedObject> objects;
  std::array<PublishedScores, 3> published;  ///< our rule, the paper's rule, random
  std::vector<InvarianceRow> invariance;
  std::vector<PrecisionRecallCurve> curves;
  std::vector<WorstFrame> worst;  ///< the first is the worst
};
inline constexpr std::array<AlgorithmIndex, 3> published_algorithms{our_rule, the_papers_rule, random_hits};

/// The paper's rule, and full stereo's crop, looking where `rule` does.
PushbroomConfig papers_rule_beside(const PushbroomConfig& rule);
FullStereoCrop crop_beside(const PushbroomConfig& rule, const StereoRig& rig);

/// Throws ScenarioError as EvaluationRecording does, or where the rule does not fit the rig. `on_frame` is
/// called after each.
RecordingEvaluation evaluate_recording(const std::filesystem::path& folder,
                                       const EvaluationSettings& settings,
                                       const std::function<void()>& on_frame);

}  // namespace understory
