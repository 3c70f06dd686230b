#include "scenarios/evaluation/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <opencv2/core/utility.hpp>
#include <thread>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/config/quiet_standard_error.hpp"
#include "scenarios/flight/stopwatch.hpp"

namespace understory {
namespace {

/// Counts frames for all workers and tells of them, one at a time.
class Progress {
 public:
  Progress(const EvaluationOptions& options, std::int64_t expected)
      : on_progress_(options.on_progress), expected_(expected) {}
  void count() {
    const std::lock_guard lock(mutex_);
    ++frames_;
    if (on_progress_) on_progress_({frames_, expected_, seconds_since(begin_)});
  }

 private:
  const std::function<void(const EvaluationProgress&)>& on_progress_;
  std::int64_t expected_ = 0, frames_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
};

/// Opens each once before the work begins, so that a fault of the last shows at once. Returns the frames to
/// come.
std::int64_t check(const EvaluationOptions& options) {
  std::int64_t frames = 0;
  StereoRig first;
  for (const auto& folder : options.folders) {
    const EvaluationRecording recording(folder);
    const StereoRig& rig = recording.rig();
    if (frames == 0) first = rig;
    if (rig.focal_px != first.focal_px || rig.baseline_m != first.baseline_m ||
        rig.width_px != first.width_px || rig.detection_depth_m != first.detection_depth_m)
      throw ScenarioError(fmt::format("{}: expected the rig of {}, found another: evaluate them apart",
                                      folder.string(), options.folders.front().string()));
    frames += (static_cast<std::int64_t>(recording.frame_count()) + options.settings.every - 1) /
              options.settings.every;
  }
  return frames;
}

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void add_curves(std::vector<PrecisionRecallCurve>& to, const std::vector<PrecisionRecallCurve>& from) {
  if (to.empty()) {
    to = from;
    return;
  }
  for (std::size_t i = 0; i < from.size(); ++i)
    for (std::size_t j = 0; j < from[i].points.size(); ++j) {
      to[i].points[j].precision.add(from[i].points[j].precision);
      to[i].points[j].recall.add(from[i].points[j].recall);
    }
}

void add_invariance(std::vector<InvarianceRow>& to, const std::vector<InvarianceRow>& from) {
  if (to.empty()) {
    to = from;
    return;
  }
  for (std::size_t i = 0; i < from.size(); ++i) {
    to[i].hits += from[i].hits;
    to[i].precision.add(from[i].precision);
    to[i].recall.add(from[i].recall);
  }
}

}  // namespace

void EvaluationSum::add(const RecordingEvaluation& recording) {
  frames += recording.frames;
  seconds += recording.seconds;
  ++recordings;
  for (std::size_t i = 0; i < algorithm_count; ++i) {
    tallies[i].add(recording.tallies[i]);
    append(sightings[i], recording.sightings[i]);
    append(cost_ms[i], recording.cost_ms[i]);
    hits[i] += recording.hits[i];
  }
  for (std::size_t i = 0; i < paced.size(); ++i) {
    paced[i].looks += recording.paced[i].looks;
    append(paced[i].sightings, recording.paced[i].sightings);
  }
  for (std::size_t i = 0; i < published.size(); ++i) published[i].add(recording.published[i]);
  add_invariance(invariance, recording.invariance);
  add_curves(curves, recording.curves);
}

bool Evaluation::has_depth() const {
  return std::ranges::any_of(recordings, &RecordingEvaluation::has_depth);
}
bool Evaluation::has_objects() const {
  return std::ranges::any_of(recordings, &RecordingEvaluation::has_objects);
}
bool Evaluation::has_poses() const {
  return std::ranges::any_of(recordings, &RecordingEvaluation::has_poses);
}

Evaluation evaluate(const EvaluationOptions& options) {
  Progress progress(options, check(options));
  cv::setNumThreads(1);  // costs are those of one thread
  Evaluation evaluation;
  evaluation.settings = options.settings;
  evaluation.recordings.resize(options.folders.size());
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const QuietStandardError quiet;  // for all workers: image libraries complain there on their own
  const auto work = [&] {
    for (std::size_t i = next++; i < options.folders.size(); i = next++) try {
        evaluation.recordings[i] =
            evaluate_recording(options.folders[i], options.settings, [&] { progress.count(); });
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (!failure) failure = std::current_exception();
        next = options.folders.size();
      }
  };
  std::vector<std::thread> workers;
  for (int i = 0; i < options.jobs; ++i) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  if (failure) std::rethrow_exception(failure);

  evaluation.all.name = "all";
  for (const RecordingEvaluation& recording : evaluation.recordings) {
    evaluation.all.add(recording);
    auto scene = std::ranges::find(evaluation.scenes, recording.scene, &EvaluationSum::name);
    if (scene == evaluation.scenes.end()) {
      scene = evaluation.scenes.insert(scene, EvaluationSum{});
      scene->name = recording.scene;
    }
    scene->add(recording);
  }
  return evaluation;
}

Share found_within(const std::vector<ObstacleSighting>& sightings, double reach_m, std::int64_t* hidden) {
  Share share;
  for (const ObstacleSighting& sighting : sightings) {
    if (sighting.miss_m > reach_m) continue;
    if (!sighting.hidden())
      share.count(sighting.found());
    else if (hidden != nullptr)
      ++*hidden;
  }
  return share;
}

}  // namespace understory
