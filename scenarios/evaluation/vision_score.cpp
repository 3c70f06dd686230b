#include "scenarios/evaluation/vision_score.hpp"

#include <fmt/format.h>

#include <utility>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/evaluation/one_pixel_counts.hpp"

namespace understory {

VisionScore summed(std::vector<RecordingScore> recordings) {
  RecordingScore sum;
  for (const RecordingScore& one : recordings) {
    sum.frames += one.frames;
    sum.precision.add(one.precision);
    sum.recall.add(one.recall);
    sum.trunks_1m.add(one.trunks_1m);
    sum.trunks_3m.add(one.trunks_3m);
  }
  VisionScore score;
  score.recordings = std::move(recordings);
  score.precision = sum.precision.value();
  score.recall = sum.recall.value();
  score.trunks_1m = sum.trunks_1m.value();
  score.trunks_3m = sum.trunks_3m.value();
  const double both = score.precision + score.recall;
  score.f_score = both > 0 ? 2 * score.precision * score.recall / both : 0;
  if (sum.frames > 0)
    score.hits_per_frame = static_cast<double>(sum.precision.of) / static_cast<double>(sum.frames);
  return score;
}

VisionData::VisionData(const std::vector<std::filesystem::path>& folders, int every) {
  for (const auto& folder : folders) {
    EvaluationRecording recording(folder);
    if (!recording.has_depth())
      throw ScenarioError(fmt::format("{}: expected true depth (mav0/depth0), found none", folder.string()));
    if (recordings_.empty()) rig_ = recording.rig();
    if (recording.rig().focal_px != rig_.focal_px || recording.rig().width_px != rig_.width_px)
      throw ScenarioError(fmt::format("{}: expected the rig of {}, found another (one search, one rig)",
                                      folder.string(), folders.front().string()));
    Recording& held = recordings_.emplace_back();
    held.name = folder.filename().string();
    held.objects = recording.objects();
    for (std::size_t i = 0; i < recording.frame_count(); i += static_cast<std::size_t>(every))
      held.frames.push_back(recording.frame(i));
    const DetectionGrid grid(rig_, usual_.depths_m, usual_.last_row_px);
    for (const EvaluationFrame& frame : held.frames)
      held.expected.push_back(expected_blocks(frame.truth, grid));
  }
}

std::size_t VisionData::frame_count() const {
  std::size_t count = 0;
  for (const Recording& recording : recordings_) count += recording.frames.size();
  return count;
}

RecordingScore VisionData::score(const Recording& recording, const PushbroomConfig& rule) const {
  PushbroomStereo detector(rig_, rule);
  const DetectionGrid grid(rig_, rule.depths_m, rule.last_row_px);
  ObstacleSightings sightings(recording.objects, rig_.baseline_m);
  RecordingScore score;
  score.name = recording.name;
  const bool looks_as_usual = rule.depths_m == usual_.depths_m && rule.last_row_px == usual_.last_row_px;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    const EvaluationFrame& frame = recording.frames[i];
    ++score.frames;
    const std::vector<StereoHit>& hits = detector.detect(frame.pair);
    std::vector<ExpectedBlock> computed;
    if (!looks_as_usual) computed = expected_blocks(frame.truth, grid);
    const std::vector<ExpectedBlock>& expected = looks_as_usual ? recording.expected[i] : computed;
    count_one_pixel(frame.truth, grid, expected, hits, score.precision, score.recall);
    sightings.add(frame, grid, expected, hits);
  }
  for (const ObstacleSighting& sighting : sightings.passed()) {
    if (sighting.hidden()) continue;
    if (sighting.miss_m <= 1) score.trunks_1m.count(sighting.found());
    if (sighting.miss_m <= 3) score.trunks_3m.count(sighting.found());
  }
  return score;
}

VisionScore VisionData::score(const PushbroomConfig& rule) const {
  std::vector<RecordingScore> scores;
  for (const Recording& recording : recordings_) scores.push_back(score(recording, rule));
  return summed(std::move(scores));
}

}  // namespace understory
