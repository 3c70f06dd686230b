#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenarios/evaluation/evaluation.hpp"
#include "scenarios/evaluation/image_pairs.hpp"
#include "scenarios/report/table.hpp"

namespace understory {

/// How one algorithm did on one pair, at all its whole disparities together.
struct PairScore {
  std::string pair, algorithm;
  int disparities = 0;  ///< that were looked at
  Rates rates = {};     ///< within one pixel, of the blocks that have a measured disparity
  /// Of the detections on calibrated pairs, those whose depth is right to each of tolerances_m.
  std::array<Share, tolerances_m.size()> within_m = {};
};

/// Scores detectors on pairs that have true disparities: at each whole disparity between the pair's own first
/// and last hundredth, as the detection depth of its own rig, or, where no calibration is known, of this one
/// (focal length and images scaled alike). Ours, the paper's parameters, StereoBM, StereoSGBM and the
/// settings' further detectors. Detections on blocks of which less than a fifth is measured count for
/// nothing. `on_disparity` is called after each. Throws ScenarioError where a pair has no disparities.
std::vector<PairScore> evaluate_pairs(const std::vector<ImagePair>& pairs, const EvaluationSettings& settings,
                                      const StereoRig& rig, const std::function<void()>& on_disparity);

/// The disparities that evaluate_pairs looks at.
std::vector<int> whole_disparities(const ImagePair& pair, const StereoRig& rig);

/// A row for each pair and algorithm, and one for all pairs. Pairs of one name (a scene) share a row.
Table pair_table(const std::vector<PairScore>& scores);

}  // namespace understory
