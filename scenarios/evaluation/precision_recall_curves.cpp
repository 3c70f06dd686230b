#include "scenarios/evaluation/precision_recall_curves.hpp"

#include "perception/full_stereo/full_stereo_detector.hpp"
#include "scenarios/evaluation/one_pixel_counts.hpp"

namespace understory {
namespace {

constexpr std::int64_t costly_every = 24, cheap_every = 4;

}  // namespace

CurveSweeps::CurveSweeps(const StereoRig& rig, const DetectionGrid& grid, const EvaluationSettings& settings)
    : grid_(grid) {
  add_rule(rig, algorithm_names[our_rule], settings.rule);
  add_rule(rig, algorithm_names[the_papers_rule], papers_rule_beside(settings.rule));

  const FullStereoCrop crop = crop_beside(settings.rule, rig);
  Sweep& block =
      sweeps_.emplace_back(Sweep{algorithm_names[stereo_bm], "uniqueness_percent", costly_every, {}, {}});
  for (const int percent : {0, 5, 10, 18, 30, 50}) {
    StereoBmConfig config = settings.stereo_bm;
    config.uniqueness_percent = percent;
    block.detectors.push_back(std::make_unique<FullStereoDetector>(rig, config, crop));
    block.points.push_back({static_cast<double>(percent), {}, {}});
  }
  Sweep& semi_global =
      sweeps_.emplace_back(Sweep{algorithm_names[stereo_sgbm], "uniqueness_percent", costly_every, {}, {}});
  for (const int percent : {0, 10, 30, 60}) {
    StereoSgbmConfig config = settings.stereo_sgbm;
    config.uniqueness_percent = percent;
    semi_global.detectors.push_back(std::make_unique<FullStereoDetector>(rig, config, crop));
    semi_global.points.push_back({static_cast<double>(percent), {}, {}});
  }
}

/// By what the rule rejects with: uniqueness where it has it, else the score.
void CurveSweeps::add_rule(const StereoRig& rig, const std::string& name, const PushbroomConfig& rule) {
  Sweep& sweep = sweeps_.emplace_back(
      Sweep{name, rule.uniqueness ? "uniqueness_ratio" : "score_limit", cheap_every, {}, {}});
  for (const double threshold :
       rule.uniqueness ? std::vector<double>{1.05, 1.2, 1.4, 1.6, 2.0, 2.5, 3.2, 4.0}
                       : std::vector<double>{0.4, 0.3, 0.22, 54.0 / 333.0, 0.12, 0.09, 0.06, 0.04}) {
    PushbroomConfig config = rule;
    (rule.uniqueness ? config.uniqueness_ratio : config.score_limit) = threshold;
    sweep.detectors.push_back(std::make_unique<PushbroomStereo>(rig, config));
    sweep.points.push_back({threshold, {}, {}});
  }
}

void CurveSweeps::add(const EvaluationFrame& frame, const std::vector<ExpectedBlock>& expected) {
  for (Sweep& sweep : sweeps_) {
    if (frames_ % sweep.every != 0) continue;
    for (std::size_t i = 0; i < sweep.detectors.size(); ++i)
      count_one_pixel(frame.truth, grid_, expected, sweep.detectors[i]->detect(frame.pair),
                      sweep.points[i].precision, sweep.points[i].recall);
  }
  ++frames_;
}

std::vector<PrecisionRecallCurve> CurveSweeps::curves() const {
  std::vector<PrecisionRecallCurve> curves;
  for (const Sweep& sweep : sweeps_) curves.push_back({sweep.algorithm, sweep.threshold, sweep.points});
  return curves;
}

}  // namespace understory
