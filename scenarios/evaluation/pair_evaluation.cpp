#include "scenarios/evaluation/pair_evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/detect/recorded_detector.hpp"
#include "scenarios/output/errors.hpp"

namespace understory {
namespace {

/// The pair's own rig, or else this one with images of its size, looking at this disparity.
StereoRig rig_looking_at(int disparity_px, const ImagePair& pair, const StereoRig& rig) {
  StereoRig looking;
  if (pair.rig) {
    looking = *pair.rig;
    looking.name = rig.name;
    looking.detection_depth_m = looking.depth_m(disparity_px);
    return looking;
  }
  looking.name = rig.name;
  looking.width_px = pair.left.cols;
  looking.height_px = pair.left.rows;
  looking.focal_px = rig.focal_px * pair.left.cols / rig.width_px;
  looking.detection_depth_m = rig.detection_depth_m;
  looking.baseline_m = disparity_px * rig.detection_depth_m / looking.focal_px;
  looking.center_left_x_px = looking.center_right_x_px = 0.5 * (pair.left.cols - 1);
  looking.center_y_px = 0.5 * (pair.left.rows - 1);
  return looking;
}

TrueImages truth_of(const ImagePair& pair, const StereoRig& rig) {
  TrueImages truth;
  // What 16 bits do not hold becomes their largest number: a false detection there is false all the same.
  depth_of_disparity(pair.disparity_px, rig).convertTo(truth.depth_mm, CV_16UC1, 1000);
  truth.shared_depth_mm = shared_depth(truth.depth_mm, rig);
  return truth;
}

std::string percent_text(const Share& share) {
  return share.of > 0 ? number_text(100 * share.value(), 1) : "-";
}

}  // namespace

std::vector<int> whole_disparities(const ImagePair& pair, const StereoRig& rig) {
  if (pair.disparity_px.empty())
    throw ScenarioError(
        fmt::format("{}: requires disparity.png or disparity.pfm beside left.png", pair.name));
  std::vector<double> known;
  for (int row = 0; row < pair.disparity_px.rows; row += 2)
    for (int column = 0; column < pair.disparity_px.cols; column += 2)
      if (const float value = pair.disparity_px.at<float>(row, column); std::isfinite(value))
        known.push_back(value);
  if (known.empty()) throw ScenarioError(pair.name + ": no pixel has a true disparity");
  std::vector<int> disparities;
  const auto last = static_cast<int>(std::floor(quantile(known, 0.99)));
  for (auto px = static_cast<int>(std::ceil(quantile(known, 0.01))); px <= last; ++px)
    if (px > 0 && rig_looking_at(px, pair, rig).can_look_at(px)) disparities.push_back(px);
  if (disparities.empty())
    throw ScenarioError(
        fmt::format("{}: no true disparity, {:.4g} to {:.4g} px, is one that images of {} px can show",
                    pair.name, quantile(known, 0.01), quantile(known, 0.99), pair.left.cols));
  return disparities;
}

std::vector<PairScore> evaluate_pairs(const std::vector<ImagePair>& pairs, const EvaluationSettings& settings,
                                      const StereoRig& rig, const std::function<void()>& on_disparity) {
  EvaluationSettings at_the_rigs_depth = settings;
  at_the_rigs_depth.pushbroom().depths_m.clear();
  at_the_rigs_depth.pushbroom().disparities_px.clear();
  std::vector<PairScore> scores;
  for (const ImagePair& pair : pairs) {
    const std::size_t first = scores.size();
    const std::vector<int> disparities = whole_disparities(pair, rig);
    for (const ComparedDetector& one : compared_detectors(at_the_rigs_depth, rig))
      scores.push_back({pair.name, one.name, static_cast<int>(disparities.size())});
    for (const int px : disparities) {
      const StereoRig looking = rig_looking_at(px, pair, rig);
      const TrueImages truth = truth_of(pair, looking);
      const DetectionGrid grid(looking, {}, settings.pushbroom().last_row_px);
      const std::vector<ExpectedBlock> expected = expected_blocks(truth, grid);
      std::size_t place = first;
      for (const ComparedDetector& one : compared_detectors(at_the_rigs_depth, looking)) {
        RecordedDetector detector(one.config, one.part, looking);
        std::vector<StereoHit> hits = detector.detector().detect({0, pair.left, pair.right});
        std::erase_if(hits, [&](const StereoHit& hit) {
          return !content_between(truth, hit.column_px, hit.row_px, {0.001, 65.535}, Surfaces::any).holds();
        });
        PairScore& score = scores[place++];
        count_one_pixel(truth, grid, expected, hits, score.rates);
        if (!pair.rig) continue;
        for (const StereoHit& hit : hits)
          for (std::size_t i = 0; i < tolerances_m.size(); ++i)
            score.within_m[i].count(true_within(hit, truth, grid)[i]);
      }
      on_disparity();
    }
  }
  return scores;
}

Table pair_table(const std::vector<PairScore>& scores) {
  std::vector<PairScore> rows;
  const auto add = [&](const std::string& pair, const PairScore& score) {
    auto row = std::ranges::find_if(
        rows, [&](const PairScore& one) { return one.pair == pair && one.algorithm == score.algorithm; });
    if (row == rows.end()) row = rows.insert(rows.end(), {pair, score.algorithm});
    row->disparities += score.disparities;
    row->rates.add(score.rates);
    for (std::size_t i = 0; i < tolerances_m.size(); ++i) row->within_m[i].add(score.within_m[i]);
  };
  for (const PairScore& score : scores) add(score.pair, score);
  for (const PairScore& score : scores) add("all", score);
  Table table{{"pair", "algorithm", "disparities", "detections", "precision, %", "blocks", "recall, %", "F"}};
  for (const double tolerance_m : tolerances_m)
    table.head.push_back(fmt::format("within {:g} m, %", tolerance_m));
  for (const PairScore& row : rows) {
    table.add(row.pair, row.algorithm, row.disparities, row.rates.precision.of,
              percent_text(row.rates.precision), row.rates.recall.of, percent_text(row.rates.recall),
              row.rates.recall.of > 0 ? number_text(row.rates.f_score(), 3) : "-");
    for (const Share& share : row.within_m) table.rows.back().push_back(percent_text(share));
  }
  return table;
}

}  // namespace understory
