#include "scenarios/evaluation/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <utility>

#include "perception/full_stereo/full_stereo.hpp"
#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "scenarios/detect/recorded_detector.hpp"
#include "scenarios/evaluation/evaluation_recording.hpp"
#include "scenarios/evaluation/ground_truth.hpp"
#include "scenarios/flight/stopwatch.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t compared_every = 8;  // the paper's evaluations: 15 frames a second
constexpr std::size_t worst_kept = 8;

/// The paper's rule, looking where `rule` does.
PushbroomConfig papers_rule_beside(const PushbroomConfig& rule) {
  PushbroomConfig paper = original_pushbroom();
  paper.depths_m = rule.depths_m;
  paper.disparities_px = rule.disparities_px;
  paper.last_row_px = rule.last_row_px;
  paper.right_margin_px = rule.right_margin_px;
  return paper;
}

/// A detector that matches every pixel, and which of these become detections.
struct DenseDetector {
  std::size_t place;  ///< among the algorithms
  const cv::Mat* depth_m;
  FullStereoCrop crop;
};

/// Every algorithm at several thresholds over the same frames: score limit or uniqueness of the pushbroom, of
/// those that match every pixel how many of a cell's pixels make a detection, and the settings' curves.
class CurveSweeps {
 public:
  /// `dense`: have looked at a frame before it is added here.
  CurveSweeps(const StereoRig& rig, const DetectionGrid& grid, const EvaluationSettings& settings,
              const std::vector<std::string>& names, const std::vector<DenseDetector>& dense)
      : rig_(rig), grid_(grid) {
    const std::vector<ComparedDetector> compared = compared_detectors(settings, rig);
    for (const auto place : {algorithm::our_rule, algorithm::the_papers_rule})
      if (compared[place].config.pushbroom().uniqueness)
        add(compared[place], "uniqueness_ratio", {1.05, 1.2, 1.4, 1.6, 2.0, 2.5, 3.2, 4.0},
            [](VisionConfig& config, double ratio) { config.pushbroom().uniqueness_ratio = ratio; });
      else
        add(compared[place], "score_limit", {0.4, 0.3, 0.22, 54.0 / 333.0, 0.12, 0.09, 0.06, 0.04},
            [](VisionConfig& config, double limit) { config.pushbroom().score_limit = limit; });
    for (const DenseDetector& one : dense) add_cells(names[one.place], one);
    for (const CurveSettings& curve : settings.curves) {
      curves_.push_back({curve.detector, curve.threshold});
      for (auto [threshold, config] : curve.points) {
        config.full_stereo = compared[0].config.full_stereo;
        add_point(threshold, curve.detector, config);
      }
    }
  }

  void add(const EvaluationFrame& frame, const std::vector<ExpectedBlock>& expected) {
    auto look = looks_.begin();
    for (PrecisionRecallCurve& curve : curves_)
      for (PrecisionRecallCurve::Point& point : curve.points)
        count_one_pixel(frame.truth, grid_, expected, (*look++)(frame.pair), point.rates);
  }
  const std::vector<PrecisionRecallCurve>& curves() const { return curves_; }

 private:
  void add_point(double threshold, const std::string& part, const VisionConfig& config) {
    curves_.back().points.push_back({threshold});
    looks_.push_back([detector = std::make_shared<RecordedDetector>(config, part, rig_)](
                         const StereoFrame& pair) { return detector->detector().detect(pair); });
  }
  void add(ComparedDetector one, const std::string& key, const std::vector<double>& thresholds,
           void (*set)(VisionConfig&, double)) {
    curves_.push_back({one.name, key});
    for (const double threshold : thresholds) {
      set(one.config, threshold);
      add_point(threshold, one.part, one.config);
    }
  }
  void add_cells(const std::string& name, DenseDetector one) {
    curves_.push_back({name, "minimum_pixels_per_cell"});
    const int pixels = one.crop.cell_px * one.crop.cell_px;
    for (int part = 1; part <= 10; ++part) {
      one.crop.minimum_pixels_per_cell = std::max(1, pixels * part / 10);
      curves_.back().points.push_back({static_cast<double>(one.crop.minimum_pixels_per_cell)});
      looks_.push_back([this, one](const StereoFrame&) {
        std::vector<StereoHit> hits;
        hits_of_depth(*one.depth_m, rig_, one.crop, hits);
        return hits;
      });
    }
  }

  StereoRig rig_;
  DetectionGrid grid_;
  std::vector<PrecisionRecallCurve> curves_;
  std::vector<std::function<std::vector<StereoHit>(const StereoFrame&)>> looks_;  ///< of all their points
};

/// What another program has found, in a detector's place.
class GivenDisparities : public ObstacleDetector {
 public:
  /// `recording`: the folder's name, which the disparities of several recordings are sorted by.
  GivenDisparities(const DisparityFolder& given, const std::string& recording, const StereoRig& rig,
                   const FullStereoCrop& crop)
      : folder_(given.folder), rig_(rig), crop_(crop) {
    std::error_code ignored;
    if (fs::is_directory(folder_ / recording, ignored)) folder_ /= recording;
  }
  const std::vector<StereoHit>& detect(const StereoFrame& frame) override {
    depth_m_ = depth_of_disparity(read_disparity(folder_, frame.t_ns, rig_), rig_);
    hits_of_depth(depth_m_, rig_, crop_, hits_);
    return hits_;
  }
  const cv::Mat& depth_m() const { return depth_m_; }

 private:
  fs::path folder_;
  StereoRig rig_;
  FullStereoCrop crop_;
  cv::Mat depth_m_;
  std::vector<StereoHit> hits_;
};

class Evaluator {
 public:
  Evaluator(const fs::path& folder, const EvaluationSettings& settings)
      : settings_(settings),
        recording_(folder),
        grid_(recording_.rig(), stated_depths_m(settings.pushbroom(), recording_.rig()),
              settings.pushbroom().last_row_px) {
    const StereoRig& rig = recording_.rig();
    check_depths(settings.pushbroom(), rig, "perception.depths_m", "perception.pushbroom");
    for (const RecordedObject& object : recording_.objects()) kinds_[object.number] = object.kind;
    if (recording_.is_raw() && !settings.disparities.empty())
      throw ScenarioError(fmt::format(
          "{}: --disparities requires a recording of rectified images; this one has raw ones (record without "
          "cameras.raw)",
          folder.string()));
    result_.sum.make_room(settings);
    const std::size_t count = result_.sum.algorithms.size();
    detectors_.resize(count);
    std::vector<double> costs_s(count, 0);  // what disparities cost nobody knows
    std::size_t next = 0;
    const std::vector<ComparedDetector> compared = compared_detectors(settings, rig);
    for (const ComparedDetector& one : compared) {
      if (next == computed_count) next = algorithm_count;
      computed_.push_back(std::make_unique<RecordedDetector>(one.config, one.part, rig));
      detectors_[next] = &computed_.back()->detector();
      if (const auto* full = dynamic_cast<const FullStereoDetector*>(detectors_[next]))
        dense_.push_back({next, &full->depth_m(), one.config.full_stereo});
      costs_s[next++] = computed_.back()->cost_s();
    }
    next = algorithm_count + settings.more_detectors.size();
    for (const DisparityFolder& given : settings.disparities) {
      const FullStereoCrop& crop = compared.front().config.full_stereo;
      given_.push_back(std::make_unique<GivenDisparities>(given, recording_name(folder), rig, crop));
      dense_.push_back({next, &given_.back()->depth_m(), crop});
      detectors_[next++] = given_.back().get();
    }
    hits_.resize(count);
    for (std::size_t i = 0; i < published_algorithms.size(); ++i)
      published_.emplace_back(rig, grid_, settings.map);
    for (std::size_t i = 0; i < count; ++i) {
      sightings_.emplace_back(recording_.objects(), rig.baseline_m);
      paced_.emplace_back(recording_.objects(), rig.baseline_m, costs_s[i]);
    }
    for (const bool on : {false, true})
      for (const auto& [name, place] :
           {std::pair("original", algorithm::the_papers_rule), std::pair("as given", algorithm::our_rule)}) {
        PushbroomConfig filtered = compared[place].config.pushbroom();
        filtered.horizontal_invariance = on;
        invariance_.emplace_back(rig, filtered);
        result_.sum.invariance.push_back({name, on});
      }
    if (recording_.has_depth())
      sweeps_ = std::make_unique<CurveSweeps>(rig, grid_, settings, result_.sum.algorithms, dense_);

    result_.folder = folder;
    result_.rig = rig;
    result_.detection_depth = grid_.depths[0];
    result_.has_depth = recording_.has_depth();
    result_.has_objects = recording_.has_objects();
    result_.has_poses = recording_.has_poses();
    result_.objects = recording_.objects();
    result_.sum.name = scene_of(folder);
    result_.sum.recordings = 1;
    result_.sum.seconds = recording_.duration_s();
  }

  RecordingEvaluation evaluate(const std::function<void()>& on_frame) {
    const auto every = static_cast<std::size_t>(settings_.every);
    for (std::size_t i = 0; i < recording_.frame_count(); i += every) {
      // Behind the last frame there is none.
      const std::int64_t next_t_ns = i + every < recording_.frame_count()
                                         ? recording_.t_ns(i + every)
                                         : std::numeric_limits<std::int64_t>::max();
      add(recording_.frame(i), i, next_t_ns);
      on_frame();
    }
    finish();
    return std::move(result_);
  }

 private:
  void detect(const EvaluationFrame& frame) {
    for (std::size_t i = 0; i < hits_.size(); ++i) {
      if (!is_computed(i)) continue;
      const auto begin = std::chrono::steady_clock::now();
      const std::vector<StereoHit>& seen = detectors_[i]->detect(frame.pair);
      result_.sum.cost_ms[i].push_back(1e3 * seconds_since(begin));
      hits_[i] = seen;
    }
    hits_[algorithm::at_random] =
        random_hits(hits_[algorithm::our_rule].size(), grid_, recording_.rig(), random_);
    if (recording_.has_depth())
      hits_[algorithm::true_depth] = true_depth_hits(frame.truth, grid_, recording_.rig());
    for (std::size_t i = 0; i < hits_.size(); ++i)
      result_.sum.hits[i] += static_cast<std::int64_t>(hits_[i].size());
  }

  void add_invariance(const EvaluationFrame& frame, const std::vector<ExpectedBlock>& expected) {
    for (std::size_t i = 0; i < invariance_.size(); ++i) {
      const std::vector<StereoHit>& hits = invariance_[i].detect(frame.pair);
      InvarianceRow& row = result_.sum.invariance[i];
      row.hits += static_cast<std::int64_t>(hits.size());
      if (recording_.has_depth()) count_one_pixel(frame.truth, grid_, expected, hits, row.rates);
    }
  }

  /// The worst of each quarter of a second, so that they show different things.
  void keep_if_bad(const EvaluationFrame& frame, std::size_t index, const std::vector<StereoHit>& hits,
                   std::vector<WorstFrame>& bad) const {
    constexpr std::size_t apart = 30;
    int false_positives = 0;
    for (const StereoHit& hit : hits) false_positives += !true_within(hit, frame.truth, grid_)[one_pixel];
    if (false_positives == 0) return;
    if (bad.empty() || index - bad.back().index >= apart)
      bad.push_back({index, false_positives, hits});
    else if (false_positives > bad.back().false_hits)
      bad.back() = {index, false_positives, hits};
  }

  /// What full stereo matches takes the truth's place: StereoBM and StereoSGBM are the first two of dense_.
  void add_agreement() {
    for (std::size_t reference = 0; reference < result_.sum.agreement.size(); ++reference) {
      TrueImages stereo;
      dense_[reference].depth_m->convertTo(stereo.depth_mm, CV_16UC1, 1000);
      stereo.shared_depth_mm = stereo.depth_mm;
      const std::vector<ExpectedBlock> expected = expected_blocks(stereo, grid_);
      for (std::size_t i = 0; i < hits_.size(); ++i)
        count_one_pixel(stereo, grid_, expected, hits_[i], result_.sum.agreement[reference][i]);
    }
  }

  /// `next_t_ns`: the moment of the frame after it.
  void add(const EvaluationFrame& frame, std::size_t index, std::int64_t next_t_ns) {
    detect(frame);
    DueBlocks due;
    if (recording_.has_depth()) {
      due = due_blocks(frame.truth, grid_);
      for (const DenseDetector& one : dense_)
        result_.sum.disparities[one.place].count(*one.depth_m, frame.truth.depth_mm, recording_.rig());
      for (std::size_t i = 0; i < hits_.size(); ++i) {
        tally(frame, grid_, recording_.rig(), kinds_, due, hits_[i], result_.sum.tallies[i]);
        sightings_[i].add(frame, grid_, due[one_pixel], hits_[i]);
      }
      for (std::size_t i = 0; i < hits_.size(); ++i)
        if (is_computed(i)) paced_[i].add(frame, next_t_ns, grid_, due[one_pixel], hits_[i]);
      const std::vector<std::size_t> places = followed(result_.sum);
      result_.worst.resize(places.size());
      for (std::size_t i = 0; i < places.size(); ++i)
        keep_if_bad(frame, index, hits_[places[i]], result_.worst[i]);
      sweeps_->add(frame, due[one_pixel]);
    } else {
      add_agreement();
    }
    add_invariance(frame, due[one_pixel]);
    for (std::size_t i = 0; i < published_.size(); ++i) {
      const std::vector<StereoHit>& hits = hits_[published_algorithms[i]];
      published_[i].remember(frame, hits);
      if (result_.sum.frames % compared_every == 0)
        published_[i].compare(frame, hits, *dense_.front().depth_m);
    }
    ++result_.sum.frames;
  }

  void finish() {
    EvaluationSum& sum = result_.sum;
    const std::vector<Passing> passings = sightings_.front().passings();
    for (std::size_t i = 0; i < hits_.size(); ++i) {
      sum.tallies[i].seconds = sum.seconds;
      if (result_.has_objects) sum.sightings[i] = sightings_[i].passed(passings);
      if (is_computed(i)) sum.paced[i] = paced_[i].result(passings);
    }
    for (std::size_t i = 0; i < published_.size(); ++i) sum.published[i] = published_[i].scores();
    if (sweeps_) sum.curves = sweeps_->curves();
    for (std::vector<WorstFrame>& worst : result_.worst) {
      std::ranges::stable_sort(worst, std::ranges::greater{}, &WorstFrame::false_hits);
      worst.resize(std::min(worst.size(), worst_kept));
    }
  }

  EvaluationSettings settings_;
  EvaluationRecording recording_;
  DetectionGrid grid_;
  std::map<int, std::string> kinds_;
  std::vector<std::unique_ptr<RecordedDetector>> computed_;
  std::vector<std::unique_ptr<GivenDisparities>> given_;
  std::vector<ObstacleDetector*> detectors_;  ///< of these; null: not computed
  std::vector<DenseDetector> dense_;          ///< with depths of this frame; StereoBM first
  std::vector<std::vector<StereoHit>> hits_;  ///< of this frame
  std::mt19937_64 random_{1};
  std::vector<PublishedEvaluations> published_;
  std::vector<ObstacleSightings> sightings_;
  std::vector<PacedSightings> paced_;
  std::vector<PushbroomStereo> invariance_;  ///< the rules of the sum's rows
  std::unique_ptr<CurveSweeps> sweeps_;      ///< where the recording has true depth
  RecordingEvaluation result_;
};

}  // namespace

FullStereoCrop crop_beside(const PerceptionSection& perception, const StereoRig& rig) {
  StereoRig looking = rig;
  if (const auto depths_m = stated_depths_m(perception.pushbroom(), rig); !depths_m.empty())
    looking.detection_depth_m = depths_m.front();
  FullStereoCrop crop = one_pixel_crop(looking);
  crop.last_row_px = perception.pushbroom().last_row_px;
  crop.cell_px = perception.full_stereo.cell_px;
  crop.minimum_pixels_per_cell = perception.full_stereo.minimum_pixels_per_cell;
  return crop;
}

std::vector<ComparedDetector> compared_detectors(const EvaluationSettings& settings, const StereoRig& rig) {
  VisionConfig ours = settings;
  ours.full_stereo = crop_beside(settings, rig);
  VisionConfig paper = ours;
  paper.pushbroom() = papers_rule_beside(settings.pushbroom());
  std::vector<ComparedDetector> detectors{{algorithm_names[algorithm::our_rule], "pushbroom", ours},
                                          {algorithm_names[algorithm::the_papers_rule], "pushbroom", paper},
                                          {algorithm_names[algorithm::stereo_bm], "stereo_bm", ours},
                                          {algorithm_names[algorithm::stereo_sgbm], "stereo_sgbm", ours}};
  for (ComparedDetector one : settings.more_detectors) {
    one.config.full_stereo = crop_beside(one.config, rig);
    detectors.push_back(std::move(one));
  }
  return detectors;
}

std::string recording_name(const fs::path& folder) {
  return folder.has_filename() ? folder.filename().string() : folder.parent_path().filename().string();
}

std::string scene_of(const fs::path& folder) {
  const std::string name = recording_name(folder);
  const std::size_t hyphen = name.find_last_of('-');
  const bool numbered = hyphen != std::string::npos && hyphen > 0 && hyphen + 1 < name.size() &&
                        name.find_first_not_of("0123456789", hyphen + 1) == std::string::npos;
  return numbered ? name.substr(0, hyphen) : name;
}

RecordingEvaluation evaluate_recording(const fs::path& folder, const EvaluationSettings& settings,
                                       const std::function<void()>& on_frame) {
  return Evaluator(folder, settings).evaluate(on_frame);
}

}  // namespace understory
