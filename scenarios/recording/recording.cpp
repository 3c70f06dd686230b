#include "scenarios/recording/recording.hpp"

#include <fmt/format.h>

#include "perception/io/pose_file.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/recording/euroc_recording.hpp"
#include "scenarios/recording/pair_recording.hpp"

namespace understory {

void Recording::on_frame(const Flight& flight) {
  observe(flight.truth());
  add(flight.frame(), *flight.cameras());
}

void Recording::observe(const Truth& truth) {
  constexpr std::int64_t kept_ns = 1'000'000'000;
  if (!recent_.empty() && recent_.back().t_ns == truth.t_ns) return;
  recent_.push_back(truth);
  while (recent_.front().t_ns < truth.t_ns - kept_ns) recent_.pop_front();
  add_step(truth);
}

void Recording::add(const StereoFrame& frame, const StereoCameras& cameras) {
  if (frame.t_ns < 0 || seen_++ % every_ != 0)
    return;  // the first image may be of a time before the first pose
  const Truth truth = truth_at(frame.t_ns);
  add_frame(frame, truth, cameras.true_view(truth.T_world_body));
  ++frames_;
}

/// An image's time may lie between two steps.
Truth Recording::truth_at(std::int64_t t_ns) const {
  auto after = recent_.begin();
  while (after != recent_.end() && after->t_ns < t_ns) ++after;
  if (after == recent_.end()) return recent_.back();
  Truth truth = *after;
  if (truth.t_ns == t_ns || after == recent_.begin()) {
    truth.t_ns = t_ns;
    return truth;
  }
  const Truth& before = *std::prev(after);
  const double share =
      static_cast<double>(t_ns - before.t_ns) / static_cast<double>(after->t_ns - before.t_ns);
  truth.t_ns = t_ns;
  truth.T_world_body = pose_between(before.T_world_body, after->T_world_body, share);
  truth.velocity_world_mps = (1 - share) * before.velocity_world_mps + share * after->velocity_world_mps;
  return truth;
}

void Recording::require_frames(const std::filesystem::path& folder) const {
  if (frames_ == 0)
    throw ScenarioError(fmt::format("{}: the scenario's cameras gave no frame", folder.string()));
}

std::unique_ptr<Recording> recording_of(const RecordingChoice& choice, const std::filesystem::path& folder,
                                        const Scenario& scenario, const CalibratedRig& rig,
                                        double expected_s) {
  if (choice.form.value_or(RecordingForm::euroc) == RecordingForm::euroc)
    return std::make_unique<EurocRecording>(folder, scenario, rig, expected_s, choice.every);
  return std::make_unique<PairRecording>(folder, rig, choice);
}

}  // namespace understory
