#include "scenarios/tuning/judge.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "scenarios/campaign/campaign_folder.hpp"
#include "scenarios/campaign/engines.hpp"
#include "scenarios/detect/recorded_detector.hpp"
#include "scenarios/evaluation/evaluation.hpp"
#include "scenarios/evaluation/evaluation_recording.hpp"
#include "scenarios/evaluation/obstacle_sightings.hpp"
#include "scenarios/evaluation/vision_tally.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t glance_part = 8;  ///< of the data, one in so many

Counts counts_of(const FlightRow& row) {
  return {row.reached_goal() ? 1.0 : 0.0,
          row.reached_goal() ? 1.0 : std::clamp(row.progress_m / row.goal_m, 0.0, 1.0), row.mean_speed_mps,
          row.position_error_mean_m};
}

/// Flights of another scenario that went by this name are of no use any more.
void keep_condition(const CampaignFolder& folder, const Campaign& campaign) {
  const Condition& condition = campaign.conditions.front();
  if (text_if_there(folder.condition_file(condition)) == condition.scenario_text) return;
  for (const CampaignTask& task : tasks_of(campaign)) fs::remove(folder.flight_file(task));
  write_whole_file(folder.condition_file(condition), condition.scenario_text);
}

class FlightJudge : public Judge {
 public:
  explicit FlightJudge(FlightJudgeConfig config) : config_(std::move(config)), folder_{config_.folder} {
    for (const char* part : {"conditions", "flights", "logs"}) prepare_output_folder(folder_.path / part);
  }

  Measured measure(const std::string& name, const Scenario& scenario, Look look) override {
    Campaign campaign;
    campaign.conditions = {{name, scenario_to_text(scenario), name, "", {}}};
    campaign.seeds = config_.seeds;
    if (look == Look::glance) campaign.seeds.resize((campaign.seeds.size() + glance_part - 1) / glance_part);
    campaign.renderer = config_.renderer;
    campaign.timeout_s = config_.timeout_s;
    keep_condition(folder_, campaign);
    const std::vector<CampaignTask> tasks = tasks_of(campaign);
    if (!fly_locally(folder_, campaign, tasks, {config_.jobs, false}, {})) throw Stopped{};
    Measured measured;
    for (const CampaignTask& task : tasks) {
      const FlightRow row = read_flight(folder_, task).value_or(FlightFile{}).row;
      if (row.status == RunStatus::killed)  // not the scenario's fault: flown again when the tuning goes on
        throw MachineError(fmt::format("{}-{}: {}; --resume goes on", name, task.seed, row.reason));
      if (!row.flown()) return {{}, fmt::format("seed {}: {}", task.seed, row.reason)};
      measured.units.push_back(counts_of(row));
    }
    return measured;
  }

  Figures figures(std::span<const Counts> units) const override {
    Figures means(flight_figure_names.size(), 0);
    for (const Counts& flight : units)
      for (std::size_t i = 0; i < means.size(); ++i) means[i] += flight[i];
    for (double& mean : means) mean /= static_cast<double>(units.size());  // all at the goal: exactly 1
    return means;
  }

 private:
  FlightJudgeConfig config_;
  CampaignFolder folder_;
};

/// A recording and its truth, held in memory for thousands of configurations.
struct HeldRecording {
  std::vector<RecordedObject> objects;
  std::vector<EvaluationFrame> frames;
  std::optional<std::vector<Passing>> passings;  ///< once they are known
  /// The blocks due in each frame where the last configuration looked: they seldom change with the next.
  std::vector<double> looked_at_m;
  int last_row_px = 0;
  std::vector<std::optional<std::vector<ExpectedBlock>>> expected;

  const std::vector<ExpectedBlock>& due(std::size_t frame, const DetectionGrid& grid) {
    if (!expected[frame]) expected[frame] = expected_blocks(frames[frame].truth, grid);
    return *expected[frame];
  }
};

class VisionJudge : public Judge {
 public:
  VisionJudge(const std::vector<std::filesystem::path>& folders, int every, int threads) : threads_(threads) {
    for (const std::filesystem::path& folder : folders) {
      EvaluationRecording recording(folder);
      if (!recording.has_depth())
        throw ScenarioError(fmt::format("{}: has no true depth (mav0/depth0)", folder.string()));
      if (recordings_.empty()) rig_ = recording.rig();
      if (!is_same_rig(recording.rig(), rig_))
        throw ScenarioError(fmt::format("{}: has another rig than {}: one tuning is for one rig",
                                        folder.string(), folders.front().string()));
      HeldRecording& held = recordings_.emplace_back();
      held.objects = recording.objects();
      for (std::size_t i = 0; i < recording.frame_count(); i += static_cast<std::size_t>(every))
        held.frames.push_back(recording.frame(i));
    }
  }

  Measured measure(const std::string&, const Scenario& scenario, Look look) override {
    VisionConfig config;
    static_cast<PerceptionSection&>(config) = scenario.perception;
    config.full_stereo = crop_beside(config, rig_);
    if (config.detector == "stereo_bm" || config.detector == "stereo_sgbm") {
      // Cropped to the rig's depth, it can find nothing at those that the pushbroom looks at in flight.
      config.pushbroom().depths_m.clear();
      config.pushbroom().disparities_px.clear();
    }
    Measured measured;
    measured.units.resize(recordings_.size());
    try {
      check_depths(config.pushbroom(), rig_, "perception.depths_m", "perception.pushbroom");
      in_parallel(recordings_.size(), threads_, [&](std::size_t i) {
        const std::size_t frames = recordings_[i].frames.size(),
                          part = (frames + glance_part - 1) / glance_part,
                          from = std::min(frames, i % glance_part * part);
        measured.units[i] = look == Look::whole
                                ? count(recordings_[i], config, 0, frames)
                                : count(recordings_[i], config, from, std::min(frames, from + part));
      });
    } catch (const ScenarioError& error) {
      return {{}, error.what()};
    }
    return measured;
  }

  Figures figures(std::span<const Counts> units) const override {
    Counts sum(units.front().size(), 0);
    for (const Counts& counts : units)
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += counts[i];
    // A share of nothing is not known: no detector may win by finding nothing.
    const auto share = [&](std::size_t i) { return sum[i + 1] > 0 ? sum[i] / sum[i + 1] : NAN; };
    const double precision = share(1), recall = share(3), both = precision + recall;
    const double f_score = both > 0 ? 2 * precision * recall / both : both;
    const double hits_per_frame = sum[0] > 0 ? sum[2] / sum[0] : NAN;
    return {precision, recall, f_score, share(5), share(7), hits_per_frame, share(9)};
  }

 private:
  /// Frames; then, of how many it holds and of how many: hits that are true, expected blocks that were hit,
  /// obstacles within 1 m and 3 m of the path that were found; of hits on obstacles and false ones those that
  /// are true.
  /// Frames outside of `from` .. `to` (not included) show where the path goes, and no more.
  Counts count(HeldRecording& recording, const VisionConfig& config, std::size_t from, std::size_t to) const {
    const PushbroomConfig& rule = config.pushbroom();
    RecordedDetector detector(config, config.detector, rig_);
    const std::vector<double> depths_m = stated_depths_m(rule, rig_);
    const DetectionGrid grid(rig_, depths_m, rule.last_row_px);
    if (recording.expected.empty() || depths_m != recording.looked_at_m ||
        rule.last_row_px != recording.last_row_px) {
      recording.looked_at_m = depths_m;
      recording.last_row_px = rule.last_row_px;
      recording.expected.assign(recording.frames.size(), std::nullopt);
    }
    ObstacleSightings sightings(recording.objects, rig_.baseline_m);
    Rates rates;
    for (std::size_t i = 0; i < recording.frames.size(); ++i) {
      const EvaluationFrame& frame = recording.frames[i];
      if (i < from || i >= to) {
        sightings.add(frame, grid, {}, {});
        continue;
      }
      const std::vector<StereoHit>& hits = detector.detector().detect(frame.pair);
      const std::vector<ExpectedBlock>& expected = recording.due(i, grid);
      count_one_pixel(frame.truth, grid, expected, hits, rates);
      sightings.add(frame, grid, expected, hits);
    }
    if (!recording.passings) recording.passings = sightings.passings();
    const std::vector<ObstacleSighting> passed = sightings.passed(*recording.passings);
    Counts counts{static_cast<double>(to - from)};
    for (const Share& share : {rates.precision, rates.recall, found_within(passed, 1),
                               found_within(passed, 3), rates.trunk_precision})
      counts.insert(counts.end(), {static_cast<double>(share.with), static_cast<double>(share.of)});
    return counts;
  }

  StereoRig rig_;
  std::vector<HeldRecording> recordings_;
  int threads_;
};

}  // namespace

const std::vector<std::string> flight_figure_names{"success", "progress", "mean_speed_mps",
                                                   "position_error_m"};

std::unique_ptr<Judge> flight_judge(FlightJudgeConfig config) {
  return std::make_unique<FlightJudge>(std::move(config));
}

const std::vector<std::string> vision_figure_names{
    "precision", "recall", "f_score", "trunks_1m", "trunks_3m", "hits_per_frame", "trunk_precision"};

bool matters_on_recordings(const Scenario& scenario, std::string_view key) {
  const std::string& detector = scenario.perception.detector;
  if (key.starts_with("perception." + detector + ".")) return true;
  if (detector.starts_with("stereo_"))
    return key == "perception.full_stereo.cell_px" || key == "perception.full_stereo.minimum_pixels_per_cell";
  return detector == "pushbroom" && key.starts_with("perception.depths_m[");
}

std::unique_ptr<Judge> vision_judge(const std::vector<std::filesystem::path>& folders, int every,
                                    int threads) {
  return std::make_unique<VisionJudge>(folders, every, threads);
}

}  // namespace understory
