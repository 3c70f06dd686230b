#include "scenarios/evaluation/recording_evaluation.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <utility>

#include "perception/full_stereo/full_stereo_detector.hpp"
#include "scenarios/evaluation/one_pixel_counts.hpp"
#include "scenarios/evaluation/precision_recall_curves.hpp"
#include "scenarios/evaluation/random_detector.hpp"
#include "scenarios/evaluation/true_depth_hits.hpp"
#include "scenarios/flight/stopwatch.hpp"
#include "scenarios/scenario/detection_depths.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t compared_every = 8;  // the paper's evaluations: 15 frames a second
constexpr std::size_t worst_kept = 8;

/// A detector and, at every frame, its hits and what they cost.
struct Timed {
  std::unique_ptr<ObstacleDetector> detector;
  std::vector<StereoHit> hits;
  double cost_ms = 0;

  void look(const StereoFrame& frame) {
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<StereoHit>& seen = detector->detect(frame);
    cost_ms = 1e3 * seconds_since(begin);
    hits = seen;
  }
};

/// "level-1203" is of the scene "level": what stands behind the last hyphen is a seed, where it is a number.
std::string scene_of(const fs::path& folder) {
  const std::string name =
      folder.has_filename() ? folder.filename().string() : folder.parent_path().filename().string();
  const std::size_t hyphen = name.find_last_of('-');
  const bool numbered = hyphen != std::string::npos && hyphen > 0 && hyphen + 1 < name.size() &&
                        name.find_first_not_of("0123456789", hyphen + 1) == std::string::npos;
  return numbered ? name.substr(0, hyphen) : name;
}

/// Of a look, on the aircraft's computer.
double cost_s(AlgorithmIndex algorithm, const ComputeConfig& compute) {
  if (algorithm == stereo_bm) return compute.factor * compute.stereo_bm_s;
  if (algorithm == stereo_sgbm) return compute.factor * compute.stereo_sgbm_s;
  return compute.factor * compute.pushbroom_s;
}

PushbroomConfig with_invariance(PushbroomConfig rule, bool on) {
  rule.horizontal_invariance = on;
  return rule;
}

/// The same frames through a rule with its filter off and on.
struct InvariancePair {
  PushbroomStereo detector;
  InvarianceRow row;
};

class Evaluator {
 public:
  Evaluator(const fs::path& folder, const EvaluationSettings& settings);
  /// `next_t_ns`: the moment of the frame after it.
  void add(const EvaluationFrame& frame, std::size_t index, std::int64_t next_t_ns);
  RecordingEvaluation finish();
  std::size_t frame_count() const { return recording_.frame_count(); }
  std::int64_t t_ns(std::size_t index) const { return recording_.t_ns(index); }
  EvaluationFrame frame(std::size_t index) { return recording_.frame(index); }

 private:
  void look(const EvaluationFrame& frame);
  void add_invariance(const EvaluationFrame& frame, const std::vector<ExpectedBlock>& expected);
  void keep_if_bad(const EvaluationFrame& frame, std::size_t index);

  EvaluationSettings settings_;
  EvaluationRecording recording_;
  DetectionGrid grid_;
  std::map<int, std::string> kinds_;
  std::array<Timed, algorithm_count> timed_;
  FullStereoDetector* stereo_bm_ = nullptr;  // timed_ owns it
  RandomDetector* random_ = nullptr;         // likewise
  std::vector<PublishedEvaluations> published_;
  std::vector<ObstacleSightings> sightings_;
  std::vector<PacedSightings> paced_;
  std::vector<InvariancePair> invariance_;
  std::unique_ptr<CurveSweeps> sweeps_;
  std::vector<WorstFrame> bad_frames_;
  RecordingEvaluation result_;
};

Evaluator::Evaluator(const fs::path& folder, const EvaluationSettings& settings)
    : settings_(settings),
      recording_(folder),
      grid_(recording_.rig(), settings.rule.depths_m, settings.rule.last_row_px) {
  const StereoRig& rig = recording_.rig();
  check_depths(settings.rule, rig, "perception.depths_m", "perception.pushbroom");
  for (const RecordedObject& object : recording_.objects()) kinds_[object.number] = object.kind;
  const PushbroomConfig paper = papers_rule_beside(settings.rule);
  const FullStereoCrop crop = crop_beside(settings.rule, rig);
  timed_[our_rule].detector = std::make_unique<PushbroomStereo>(rig, settings.rule);
  timed_[the_papers_rule].detector = std::make_unique<PushbroomStereo>(rig, paper);
  auto bm = std::make_unique<FullStereoDetector>(rig, settings.stereo_bm, crop);
  stereo_bm_ = bm.get();
  timed_[stereo_bm].detector = std::move(bm);
  timed_[stereo_sgbm].detector = std::make_unique<FullStereoDetector>(rig, settings.stereo_sgbm, crop);
  auto random = std::make_unique<RandomDetector>(rig, grid_, 1);
  random_ = random.get();
  timed_[random_hits].detector = std::move(random);
  for (std::size_t i = 0; i < published_algorithms.size(); ++i)
    published_.emplace_back(rig, grid_, settings.map);
  for (int i = 0; i < algorithm_count; ++i) sightings_.emplace_back(recording_.objects(), rig.baseline_m);
  for (const AlgorithmIndex i : paced_algorithms)
    paced_.emplace_back(recording_.objects(), rig.baseline_m, cost_s(i, settings.compute));
  for (const bool on : {false, true}) {
    invariance_.push_back({PushbroomStereo(rig, with_invariance(paper, on)), {"the paper's", on, 0, {}, {}}});
    invariance_.push_back(
        {PushbroomStereo(rig, with_invariance(settings.rule, on)), {"ours", on, 0, {}, {}}});
  }
  if (recording_.has_depth()) sweeps_ = std::make_unique<CurveSweeps>(rig, grid_, settings);

  result_.folder = folder;
  result_.scene = scene_of(folder);
  result_.rig = rig;
  result_.detection_depth_m = grid_.depths[0].depth_m;
  result_.one_pixel = grid_.depths[0].one_pixel;
  result_.seconds = recording_.duration_s();
  result_.has_depth = recording_.has_depth();
  result_.has_objects = recording_.has_objects();
  result_.has_poses = recording_.has_poses();
  result_.has_estimates = recording_.has_estimates();
  result_.objects = recording_.objects();
}

void Evaluator::look(const EvaluationFrame& frame) {
  for (const int i : {our_rule, the_papers_rule, stereo_bm, stereo_sgbm})
    timed_[static_cast<std::size_t>(i)].look(frame.pair);
  random_->set_count(timed_[our_rule].hits.size());
  timed_[random_hits].look(frame.pair);
  if (recording_.has_depth()) timed_[true_depth].hits = true_depth_hits(frame.truth, grid_, recording_.rig());
  for (std::size_t i = 0; i < algorithm_count; ++i) {
    result_.hits[i] += static_cast<std::int64_t>(timed_[i].hits.size());
    if (i != true_depth && i != random_hits) result_.cost_ms[i].push_back(timed_[i].cost_ms);
  }
}

void Evaluator::add_invariance(const EvaluationFrame& frame, const std::vector<ExpectedBlock>& expected) {
  for (InvariancePair& pair : invariance_) {
    const std::vector<StereoHit>& hits = pair.detector.detect(frame.pair);
    pair.row.hits += static_cast<std::int64_t>(hits.size());
    if (recording_.has_depth())
      count_one_pixel(frame.truth, grid_, expected, hits, pair.row.precision, pair.row.recall);
  }
}

/// The worst of each quarter of a second, so that they show different things.
void Evaluator::keep_if_bad(const EvaluationFrame& frame, std::size_t index) {
  int false_positives = 0;
  for (const StereoHit& hit : timed_[our_rule].hits)
    false_positives += !judge(hit, frame.truth, grid_)[one_pixel];
  if (false_positives == 0) return;
  constexpr std::size_t apart = 30;
  if (!bad_frames_.empty() && index - bad_frames_.back().index < apart) {
    if (false_positives > bad_frames_.back().false_hits) bad_frames_.back() = {index, false_positives};
    return;
  }
  bad_frames_.push_back({index, false_positives});
}

void Evaluator::add(const EvaluationFrame& frame, std::size_t index, std::int64_t next_t_ns) {
  look(frame);
  DueBlocks due;
  if (recording_.has_depth()) {
    due = due_blocks(frame.truth, grid_);
    for (std::size_t i = 0; i < algorithm_count; ++i) {
      tally(frame, grid_, recording_.rig(), kinds_, due, timed_[i].hits, result_.tallies[i]);
      sightings_[i].add(frame, grid_, due[one_pixel], timed_[i].hits);
    }
    for (std::size_t i = 0; i < paced_.size(); ++i)
      paced_[i].add(frame, next_t_ns, grid_, due[one_pixel], timed_[paced_algorithms[i]].hits);
    keep_if_bad(frame, index);
    sweeps_->add(frame, due[one_pixel]);
  }
  add_invariance(frame, due[one_pixel]);
  for (std::size_t i = 0; i < published_.size(); ++i) {
    const std::vector<StereoHit>& hits = timed_[published_algorithms[i]].hits;
    published_[i].remember(frame, hits);
    if (result_.frames % static_cast<std::int64_t>(compared_every) == 0)
      published_[i].compare(frame, hits, stereo_bm_->depth_m());
  }
  ++result_.frames;
}

RecordingEvaluation Evaluator::finish() {
  for (std::size_t i = 0; i < algorithm_count; ++i) {
    result_.tallies[i].seconds = result_.seconds;
    if (result_.has_objects) result_.sightings[i] = sightings_[i].passed();
  }
  for (std::size_t i = 0; i < paced_.size(); ++i) result_.paced[i] = paced_[i].result();
  for (std::size_t i = 0; i < published_.size(); ++i) result_.published[i] = published_[i].scores();
  for (const InvariancePair& pair : invariance_) result_.invariance.push_back(pair.row);
  if (sweeps_) result_.curves = sweeps_->curves();
  std::ranges::stable_sort(bad_frames_, std::ranges::greater{}, &WorstFrame::false_hits);
  bad_frames_.resize(std::min(bad_frames_.size(), worst_kept));
  result_.worst = bad_frames_;
  return std::move(result_);
}

}  // namespace

PushbroomConfig papers_rule_beside(const PushbroomConfig& rule) {
  PushbroomConfig paper = paper_rule();
  paper.depths_m = rule.depths_m;
  paper.last_row_px = rule.last_row_px;
  return paper;
}

FullStereoCrop crop_beside(const PushbroomConfig& rule, const StereoRig& rig) {
  FullStereoCrop crop = one_pixel_crop(rig);
  crop.last_row_px = rule.last_row_px;
  return crop;
}

RecordingEvaluation evaluate_recording(const fs::path& folder, const EvaluationSettings& settings,
                                       const std::function<void()>& on_frame) {
  Evaluator evaluator(folder, settings);
  const auto every = static_cast<std::size_t>(settings.every);
  for (std::size_t i = 0; i < evaluator.frame_count(); i += every) {
    // Behind the last frame there is none.
    const std::int64_t next_t_ns = i + every < evaluator.frame_count()
                                       ? evaluator.t_ns(i + every)
                                       : std::numeric_limits<std::int64_t>::max();
    evaluator.add(evaluator.frame(i), i, next_t_ns);
    on_frame();
  }
  return evaluator.finish();
}

}  // namespace understory
