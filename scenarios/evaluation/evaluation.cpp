#include "scenarios/evaluation/evaluation.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>
#include <opencv2/core/utility.hpp>
#include <set>

#include "perception/io/calibration/calibration_file.hpp"
#include "perception/io/image_sequence.hpp"
#include "scenarios/config/bad_input.hpp"
#include "scenarios/evaluation/evaluation_recording.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// Opens each once before the work begins, so that a fault of the last shows at once. Returns the frames to
/// come.
std::int64_t check(const EvaluationOptions& options) {
  std::int64_t frames = 0;
  StereoRig first;
  std::set<fs::path> folders;
  std::set<std::string> disparities;
  for (const auto& folder : options.folders) {
    const EvaluationRecording recording(folder);
    if (!folders.insert(fs::canonical(*euroc_folder(folder))).second)
      throw ScenarioError(fmt::format("{}: is given twice", folder.string()));
    for (const DisparityFolder& given : options.settings.disparities) {
      const fs::path own = given.folder / recording_name(folder);
      if (options.folders.size() > 1 &&
          (!fs::is_directory(own) || !disparities.insert(given.name + "=" + own.string()).second))
        throw ScenarioError(fmt::format(
            "--disparities {}={}: of several recordings each needs a folder of its own there, named as "
            "the recording's: {} is missing, or two recordings have this name",
            given.name, given.folder.string(), own.string()));
    }
    if (frames == 0) first = recording.rig();
    if (!is_same_rig(recording.rig(), first))
      throw ScenarioError(fmt::format("{}: has another rig than {}: evaluate them apart", folder.string(),
                                      options.folders.front().string()));
    frames += (static_cast<std::int64_t>(recording.frame_count()) + options.settings.every - 1) /
              options.settings.every;
  }
  return frames;
}

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void EvaluationSum::make_room(const EvaluationSettings& settings) {
  algorithms.assign(algorithm_names.begin(), algorithm_names.end());
  for (const ComparedDetector& one : settings.more_detectors) algorithms.push_back(one.name);
  for (const DisparityFolder& given : settings.disparities) algorithms.push_back(given.name);
  for (auto one = algorithms.begin(); one != algorithms.end(); ++one)
    if (std::find(algorithms.begin(), one, *one) != one)
      throw ScenarioError(*one + ": two algorithms have this name; each needs a name of its own");
  const std::size_t count = algorithms.size();
  tallies.resize(count);
  sightings.resize(count);
  hits.resize(count);
  paced.resize(count);
  cost_ms.resize(count);
  disparities.resize(count);
  for (std::vector<Rates>& rates : agreement) rates.resize(count);
}

void EvaluationSum::add(const EvaluationSum& other) {
  frames += other.frames;
  recordings += other.recordings;
  seconds += other.seconds;
  for (std::size_t i = 0; i < algorithms.size(); ++i) {
    tallies[i].add(other.tallies[i]);
    append(sightings[i], other.sightings[i]);
    hits[i] += other.hits[i];
    append(cost_ms[i], other.cost_ms[i]);
    paced[i].frames += other.paced[i].frames;
    append(paced[i].sightings, other.paced[i].sightings);
    disparities[i].add(other.disparities[i]);
    for (std::size_t j = 0; j < agreement.size(); ++j) agreement[j][i].add(other.agreement[j][i]);
  }
  for (std::size_t i = 0; i < published.size(); ++i) published[i].add(other.published[i]);
  for (std::size_t i = 0; i < invariance.size(); ++i) {
    invariance[i].hits += other.invariance[i].hits;
    invariance[i].rates.add(other.invariance[i].rates);
  }
  if (invariance.empty()) invariance = other.invariance;
  for (std::size_t i = 0; i < curves.size() && i < other.curves.size(); ++i)
    for (std::size_t j = 0; j < curves[i].points.size(); ++j)
      curves[i].points[j].rates.add(other.curves[i].points[j].rates);
  if (curves.empty()) curves = other.curves;
}

std::vector<std::size_t> followed(const EvaluationSum& sum) {
  std::vector<std::size_t> places{algorithm::our_rule};
  for (std::size_t i = algorithm_count; i < sum.algorithms.size(); ++i) places.push_back(i);
  return places;
}

void in_parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  tbb::task_arena arena(threads);
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, work, tbb::simple_partitioner()); });
}

Evaluation evaluate(const EvaluationOptions& options) {
  const std::int64_t expected = check(options);
  cv::setNumThreads(1);  // costs are those of one thread
  Evaluation evaluation;
  evaluation.settings = options.settings;
  evaluation.recordings.resize(options.folders.size());
  std::int64_t frames = 0;
  std::mutex mutex;                // of the number of frames
  const QuietStandardError quiet;  // for all workers: image libraries complain there on their own
  const auto count_frame = [&] {
    const std::lock_guard lock(mutex);
    options.on_progress(++frames, expected);
  };
  in_parallel(options.folders.size(), options.jobs, [&](std::size_t i) {
    evaluation.recordings[i] = evaluate_recording(options.folders[i], options.settings, count_frame);
  });

  evaluation.all.name = "all";
  evaluation.all.make_room(options.settings);
  for (const RecordingEvaluation& recording : evaluation.recordings) {
    evaluation.all.add(recording.sum);
    evaluation.has_depth |= recording.has_depth;
    evaluation.has_objects |= recording.has_objects;
    evaluation.has_poses |= recording.has_poses;
    const auto scene = std::ranges::find(evaluation.scenes, recording.sum.name, &EvaluationSum::name);
    if (scene == evaluation.scenes.end())
      evaluation.scenes.push_back(recording.sum);
    else
      scene->add(recording.sum);
  }
  return evaluation;
}

}  // namespace understory
