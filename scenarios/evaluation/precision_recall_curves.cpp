#include "scenarios/evaluation/precision_recall_curves.hpp"

namespace understory {

CurveSweeps::CurveSweeps(const StereoRig& rig, const DetectionGrid& grid, const EvaluationSettings& settings)
    : grid_(grid) {
  const FullStereoCrop crop = crop_beside(settings.pushbroom, rig);
  add_rule(rig, algorithm_names[our_rule], settings.pushbroom);
  add_rule(rig, algorithm_names[the_papers_rule], papers_rule_beside(settings.pushbroom));
  add_full_stereo(rig, algorithm_names[stereo_bm], settings.stereo_bm, crop, {0, 5, 10, 18, 30, 50});
  add_full_stereo(rig, algorithm_names[stereo_sgbm], settings.stereo_sgbm, crop, {0, 10, 30, 60});
}

/// By what the rule rejects with: uniqueness where it has it, else the score.
void CurveSweeps::add_rule(const StereoRig& rig, const std::string& name, const PushbroomConfig& rule) {
  curves_.push_back({name, rule.uniqueness ? "uniqueness_ratio" : "score_limit"});
  detectors_.emplace_back();
  for (const double threshold :
       rule.uniqueness ? std::vector<double>{1.05, 1.2, 1.4, 1.6, 2.0, 2.5, 3.2, 4.0}
                       : std::vector<double>{0.4, 0.3, 0.22, 54.0 / 333.0, 0.12, 0.09, 0.06, 0.04}) {
    PushbroomConfig config = rule;
    (rule.uniqueness ? config.uniqueness_ratio : config.score_limit) = threshold;
    curves_.back().points.push_back({threshold});
    detectors_.back().push_back(std::make_unique<PushbroomStereo>(rig, config));
  }
}

template <typename Config>
void CurveSweeps::add_full_stereo(const StereoRig& rig, const std::string& name, Config config,
                                  const FullStereoCrop& crop, const std::vector<int>& uniqueness_percent) {
  curves_.push_back({name, "uniqueness_percent"});
  detectors_.emplace_back();
  for (const int percent : uniqueness_percent) {
    config.uniqueness_percent = percent;
    curves_.back().points.push_back({static_cast<double>(percent)});
    detectors_.back().push_back(std::make_unique<FullStereoDetector>(rig, config, crop));
  }
}

void CurveSweeps::add(const EvaluationFrame& frame, const std::vector<ExpectedBlock>& expected) {
  for (std::size_t curve = 0; curve < curves_.size(); ++curve)
    for (std::size_t point = 0; point < curves_[curve].points.size(); ++point)
      count_one_pixel(frame.truth, grid_, expected, detectors_[curve][point]->detect(frame.pair),
                      curves_[curve].points[point].rates);
}

}  // namespace understory
