#include "scenarios/evaluation/evaluation_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scenarios/evaluation/obstacle_tables.hpp"
#include "scenarios/evaluation/share_text.hpp"
#include "scenarios/statistics/samples.hpp"

namespace understory {
namespace {

std::string percent_text(double share) { return fmt::format("{:.1f}", 100 * share); }

/// Blocks of one flight resemble each other: the interval comes from drawing recordings anew.
std::string resampled_text(const Evaluation& evaluation, Share (*of)(const RecordingEvaluation&)) {
  std::vector<double> indices(evaluation.recordings.size());
  std::iota(indices.begin(), indices.end(), 0.0);
  const auto pooled = [&](std::span<const double> drawn) {
    Share sum;
    for (const double index : drawn) sum.add(of(evaluation.recordings[static_cast<std::size_t>(index)]));
    return sum.value();
  };
  const double value = pooled(indices);
  if (indices.size() < 2) return fmt::format("{:.3f}", value);
  const BootstrapEstimate estimate = bootstrap(indices, pooled, {.resamples = 2000});
  return fmt::format("{:.3f} ({:.3f} to {:.3f})", value, estimate.interval.minimum,
                     estimate.interval.maximum);
}

/// The paper's figures of one sum, the scene's name in front.
void add_published(const EvaluationSum& sum, bool has_poses, Table& table) {
  const PublishedFigures paper;
  const auto& [ours, papers_rule, random] = sum.published;
  const auto row = [&](const char* what, double published, auto figure, std::string published_random) {
    table.rows.push_back({sum.name, what, percent_text(published), percent_text(figure(ours)),
                          percent_text(figure(papers_rule)), percent_text(figure(random)),
                          std::move(published_random)});
  };
  using Scores = PublishedScores;
  row(
      "1 single frame: within 0.5 m", paper.single_within_half_m,
      [](const Scores& s) { return s.single_frame.share_within(0.5); }, "-");
  row(
      "1 single frame: within 1.0 m", paper.single_within_1_m,
      [](const Scores& s) { return s.single_frame.share_within(1); }, "-");
  row(
      "1 single frame: no match on the frame", paper.single_no_match,
      [](const Scores& s) { return s.single_frame.share_without_match(); }, "-");
  if (!has_poses) return;
  row(
      "2 remembered: within 0.5 m", paper.remembered_within_half_m,
      [](const Scores& s) { return s.false_positives.share_within(0.5); },
      percent_text(paper.random_within_half_m));
  row(
      "2 remembered: within 1.0 m", paper.remembered_within_1_m,
      [](const Scores& s) { return s.false_positives.share_within(1); },
      percent_text(paper.random_within_1_m));
  row(
      "3 missed by 1.0 m or more", paper.missed_by_1_m,
      [](const Scores& s) { return 1 - s.false_negatives.share_within(1); },
      percent_text(paper.random_missed_by_1_m));
  row(
      "3 found within 2.0 m", paper.found_within_2_m,
      [](const Scores& s) { return s.false_negatives.share_within(2); }, "-");
}

EvaluationTable published_table(const Evaluation& evaluation) {
  EvaluationTable table{"paper",
                        "The paper's evaluations, StereoBM as truth; percent",
                        {{"scene", "evaluation", "the paper", "our rule", "the paper's rule", "random, here",
                          "random, the paper"},
                         {}}};
  constexpr std::size_t few = 3;  // of more scenes only the sum, or nobody would read it
  if (evaluation.scenes.size() > 1 && evaluation.scenes.size() <= few)
    for (const EvaluationSum& scene : evaluation.scenes)
      add_published(scene, evaluation.has_poses(), table.table);
  add_published(evaluation.all, evaluation.has_poses(), table.table);
  return table;
}

EvaluationTable algorithms_table(const Evaluation& evaluation) {
  EvaluationTable table{
      "algorithms",
      "Against the truth, all looking within one pixel of the detection depth; cost on one thread",
      {{"algorithm", "hits/frame", "precision 0.25 m", "0.50 m", "1.00 m", "one pixel", "recall 0.25 m",
        "0.50 m", "1.00 m", "one pixel", "F", "false/s", "found 1 m", "found 3 m", "ms/frame"},
       {}}};
  const EvaluationSum& all = evaluation.all;
  for (std::size_t i = 0; i < algorithm_count; ++i) {
    const VisionTally& tally = all.tallies[i];
    std::vector<std::string> row{
        algorithm_names[i],
        fmt::format("{:.1f}", static_cast<double>(all.hits[i]) /
                                  static_cast<double>(std::max<std::int64_t>(1, all.frames)))};
    for (const Share& share : tally.precision) row.push_back(share_text(share));
    for (const Share& share : tally.recall) row.push_back(share_text(share));
    row.push_back(fmt::format("{:.3f}", tally.f_score()));
    row.push_back(fmt::format("{:.0f}", tally.false_per_second()));
    for (const double reach_m : {1.0, 3.0})
      row.push_back(share_text(found_within(all.sightings[i], reach_m)));
    row.push_back(all.cost_ms[i].empty() ? "-" : fmt::format("{:.3f}", quantile(all.cost_ms[i], 0.5)));
    table.table.rows.push_back(std::move(row));
  }
  return table;
}

EvaluationTable scenes_table(const Evaluation& evaluation) {
  EvaluationTable table{"scenes",
                        "Our rule in every scene, at one pixel",
                        {{"scene", "recordings", "s", "hits/frame", "precision", "recall", "false/s",
                          "found 1 m", "of", "found 3 m", "of", "hidden"},
                         {}}};
  const auto add = [&](const EvaluationSum& sum) {
    std::int64_t hidden = 0;
    const Share near = found_within(sum.sightings[our_rule], 1),
                far = found_within(sum.sightings[our_rule], 3, &hidden);
    const VisionTally& tally = sum.tallies[our_rule];
    table.table.rows.push_back(
        {sum.name, fmt::format("{}", sum.recordings), fmt::format("{:.1f}", sum.seconds),
         fmt::format("{:.1f}", static_cast<double>(sum.hits[our_rule]) /
                                   static_cast<double>(std::max<std::int64_t>(1, sum.frames))),
         share_text(tally.precision[one_pixel]), share_text(tally.recall[one_pixel]),
         fmt::format("{:.0f}", tally.false_per_second()), share_text(near), fmt::format("{}", near.of),
         share_text(far), fmt::format("{}", far.of), fmt::format("{}", hidden)});
  };
  for (const EvaluationSum& scene : evaluation.scenes) add(scene);
  if (evaluation.scenes.size() > 1) add(evaluation.all);
  return table;
}

EvaluationTable intervals_table(const Evaluation& evaluation) {
  EvaluationTable table{"intervals",
                        "With 95 % intervals: precision and recall at one pixel by drawing recordings anew, "
                        "obstacles after Wilson",
                        {{"algorithm", "precision", "recall", "found within 1 m", "found within 3 m"}, {}}};
  const auto add = [&](AlgorithmIndex index, auto precision, auto recall) {
    const auto& sightings = evaluation.all.sightings[index];
    table.table.rows.push_back({algorithm_names[index], resampled_text(evaluation, precision),
                                resampled_text(evaluation, recall), wilson_text(found_within(sightings, 1)),
                                wilson_text(found_within(sightings, 3))});
  };
  using One = RecordingEvaluation;
  add(
      our_rule, [](const One& r) { return r.tallies[our_rule].precision[one_pixel]; },
      [](const One& r) { return r.tallies[our_rule].recall[one_pixel]; });
  add(
      the_papers_rule, [](const One& r) { return r.tallies[the_papers_rule].precision[one_pixel]; },
      [](const One& r) { return r.tallies[the_papers_rule].recall[one_pixel]; });
  add(
      stereo_bm, [](const One& r) { return r.tallies[stereo_bm].precision[one_pixel]; },
      [](const One& r) { return r.tallies[stereo_bm].recall[one_pixel]; });
  add(
      stereo_sgbm, [](const One& r) { return r.tallies[stereo_sgbm].precision[one_pixel]; },
      [](const One& r) { return r.tallies[stereo_sgbm].recall[one_pixel]; });
  return table;
}

EvaluationTable parts_table(const Evaluation& evaluation) {
  EvaluationTable table{"parts",
                        "Our rule by parts, at one pixel",
                        {{"by", "part", "hits", "precision", "blocks", "recall"}, {}}};
  for (const auto& [name, bins] : evaluation.all.tallies[our_rule].parts)
    for (const auto& [bin, part] : bins) {
      const std::size_t space = bin.find(' ');  // behind the number that sorts
      const bool numbered = name != "kind" && space != std::string::npos;
      table.table.rows.push_back({name, numbered ? bin.substr(space + 1) : bin,
                                  fmt::format("{}", part.precision.of), share_text(part.precision),
                                  fmt::format("{}", part.recall.of), share_text(part.recall)});
    }
  return table;
}

EvaluationTable false_hits_table(const Evaluation& evaluation) {
  EvaluationTable table{"false_hits",
                        "What false hits lie on, a second, at one pixel",
                        {{"on", "our rule", "the paper's rule", "StereoBM", "StereoSGBM"}, {}}};
  const auto& tallies = evaluation.all.tallies;
  std::map<std::string, std::int64_t> all;
  for (const std::size_t i : {our_rule, the_papers_rule, stereo_bm, stereo_sgbm})
    for (const auto& [what, count] : tallies[i].false_on) all[what] += count;
  for (const auto& [what, count] : all) {
    std::vector<std::string> row{what};
    for (const std::size_t i : {our_rule, the_papers_rule, stereo_bm, stereo_sgbm}) {
      const auto found = tallies[i].false_on.find(what);
      const double false_positives =
          found == tallies[i].false_on.end() ? 0 : static_cast<double>(found->second);
      row.push_back(fmt::format("{:.1f}", tallies[i].seconds > 0 ? false_positives / tallies[i].seconds : 0));
    }
    table.table.rows.push_back(std::move(row));
  }
  return table;
}

EvaluationTable invariance_table(const Evaluation& evaluation) {
  EvaluationTable table{
      "invariance",
      "Horizontal-invariance filter off and on, at one pixel",
      {{"scene", "rule", "filter", "hits/frame", "precision", "recall", "false/frame"}, {}}};
  const auto add = [&](const EvaluationSum& sum) {
    const auto frames = static_cast<double>(std::max<std::int64_t>(1, sum.frames));
    for (const InvarianceRow& row : sum.invariance)
      table.table.rows.push_back(
          {sum.name, row.rule, row.filter ? "on" : "off",
           fmt::format("{:.2f}", static_cast<double>(row.hits) / frames), share_text(row.precision),
           share_text(row.recall),
           fmt::format("{:.2f}", static_cast<double>(row.precision.of - row.precision.with) / frames)});
  };
  for (const EvaluationSum& scene : evaluation.scenes) add(scene);
  if (evaluation.scenes.size() > 1) add(evaluation.all);
  return table;
}

}  // namespace

std::vector<EvaluationTable> evaluation_tables(const Evaluation& evaluation) {
  std::vector<EvaluationTable> tables{published_table(evaluation)};
  if (evaluation.has_depth()) {
    tables.push_back(algorithms_table(evaluation));
    tables.push_back(intervals_table(evaluation));
    tables.push_back(scenes_table(evaluation));
    if (evaluation.has_objects()) {
      tables.push_back(computer_table(evaluation));
      tables.push_back(on_the_path_table(evaluation));
    }
    tables.push_back(parts_table(evaluation));
    tables.push_back(false_hits_table(evaluation));
  }
  tables.push_back(invariance_table(evaluation));
  return tables;
}

}  // namespace understory
