#include "scenarios/tuning/vision_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/scenario/detection_depths.hpp"

namespace understory {
namespace {

void append(const Share& share, Counts& counts) {
  counts.push_back(static_cast<double>(share.with));
  counts.push_back(static_cast<double>(share.of));
}

Counts counts_of(const RecordingScore& score) {
  Counts counts{static_cast<double>(score.frames)};
  for (const Share* share : {&score.precision, &score.recall, &score.trunks_1m, &score.trunks_3m})
    append(*share, counts);
  return counts;
}

RecordingScore score_of(const Counts& counts) {
  const auto count = [&](std::size_t i) { return static_cast<std::int64_t>(counts[i]); };
  const auto share = [&](std::size_t i) { return Share{.of = count(i + 1), .with = count(i)}; };
  return {"", count(0), share(1), share(3), share(5), share(7)};
}

}  // namespace

bool matters_on_recordings(std::string_view key) {
  return key.starts_with("perception.pushbroom.") || key.starts_with("perception.depths_m[");
}

VisionJudge::VisionJudge(const std::vector<std::filesystem::path>& folders, int every, int threads)
    : threads_(threads) {
  for (const std::filesystem::path& folder : folders) {
    recordings_.emplace_back(std::vector{folder}, every);
    const StereoRig& rig = recordings_.back().rig();
    const StereoRig& first = recordings_.front().rig();
    if (rig.focal_px != first.focal_px || rig.width_px != first.width_px ||
        rig.baseline_m != first.baseline_m)
      throw ScenarioError(fmt::format("{}: expected the rig of {}, found another (one tuning, one rig)",
                                      folder.string(), folders.front().string()));
  }
}

Measured VisionJudge::measure(const std::string&, const Scenario& scenario) {
  const PushbroomConfig& rule = scenario.perception.pushbroom;
  try {
    check_depths(rule, recordings_.front().rig(), "perception.depths_m", "perception.pushbroom");
  } catch (const ScenarioError& error) {
    return {{}, error.what()};
  }
  Measured measured;
  measured.units.resize(recordings_.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < recordings_.size();)
      measured.units[i] = counts_of(recordings_[i].score(rule).recordings.front());
  };
  std::vector<std::jthread> others;
  const auto threads = std::min(static_cast<std::size_t>(threads_), recordings_.size());
  for (std::size_t i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  others.clear();  // joins
  return measured;
}

Figures VisionJudge::figures(std::span<const Counts> units) const {
  std::vector<RecordingScore> scores;
  for (const Counts& counts : units) scores.push_back(score_of(counts));
  const VisionScore score = summed(std::move(scores));
  return {score.precision, score.recall,    score.f_score,
          score.trunks_1m, score.trunks_3m, score.hits_per_frame};
}

}  // namespace understory
