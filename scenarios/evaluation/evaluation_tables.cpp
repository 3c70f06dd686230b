#include "scenarios/evaluation/evaluation_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "scenarios/statistics/statistics.hpp"

namespace understory {
namespace {

/// All that are computed.
std::vector<std::size_t> compared(const EvaluationSum& sum) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < sum.algorithms.size(); ++i)
    if (is_computed(i)) places.push_back(i);
  return places;
}

std::string percent(double share) { return number_text(100 * share, 1); }
std::string per_frame(std::int64_t value, const EvaluationSum& sum, int decimals) {
  return number_text(static_cast<double>(value) / static_cast<double>(std::max<std::int64_t>(1, sum.frames)),
                     decimals);
}

/// "-" where nothing was counted.
std::string share_text(const Share& share) { return share.of > 0 ? number_text(share.value(), 3) : "-"; }
std::string with_interval(double value, const Interval& interval) {
  return fmt::format("{:.3f} ({:.3f} to {:.3f})", value, interval.minimum, interval.maximum);
}
std::string wilson_text(const Share& share) {
  if (share.of == 0) return "-";
  return with_interval(share.value(),
                       wilson_interval(static_cast<int>(share.with), static_cast<int>(share.of)));
}

/// Of a rate at one pixel. Blocks of one flight resemble each other: the interval comes from drawing
/// recordings anew.
std::string resampled_text(const Evaluation& evaluation, std::size_t algorithm, Share Rates::*rate) {
  std::vector<double> indices(evaluation.recordings.size());
  std::iota(indices.begin(), indices.end(), 0.0);
  const auto pooled = [&](std::span<const double> drawn) {
    Share sum;
    for (const double index : drawn)
      sum.add(evaluation.recordings[static_cast<std::size_t>(index)].sum.tallies[algorithm].at_one_pixel().*
              rate);
    return sum.value();
  };
  if (indices.size() < 2) return number_text(pooled(indices), 3);
  return with_interval(pooled(indices), bootstrap(indices, pooled, {.resamples = 2000}).interval);
}

/// Every scene, and their sum where there are several.
template <typename Add>
void for_each_scene(const Evaluation& evaluation, Add&& add) {
  for (const EvaluationSum& scene : evaluation.scenes) add(scene);
  if (evaluation.scenes.size() > 1) add(evaluation.all);
}

/// A figure of the paper's evaluations (Barry & Tedrake 2015), shares of 1.
struct PublishedRow {
  const char* what;
  DistanceHistogram PublishedScores::*histogram;
  double (*figure)(const DistanceHistogram&);
  double paper;
  std::optional<double> papers_random = {};
  bool needs_poses() const { return histogram != &PublishedScores::single_frame; }
};

template <int half_metres>
double within(const DistanceHistogram& histogram) {
  return histogram.share_within(0.5 * half_metres);
}
double without_match(const DistanceHistogram& histogram) { return histogram.share_without_match(); }
double beyond_a_metre(const DistanceHistogram& histogram) { return 1 - histogram.share_within(1); }

const std::vector<PublishedRow> published_rows{
    {"1 single frame: within 0.5 m", &PublishedScores::single_frame, within<1>, 0.609},
    {"1 single frame: within 1.0 m", &PublishedScores::single_frame, within<2>, 0.712},
    {"1 single frame: no match on the frame", &PublishedScores::single_frame, without_match, 0.082},
    {"2 remembered: within 0.5 m", &PublishedScores::false_positives, within<1>, 0.748, 0.012},
    {"2 remembered: within 1.0 m", &PublishedScores::false_positives, within<2>, 0.926, 0.032},
    {"3 missed by 1.0 m or more", &PublishedScores::false_negatives, beyond_a_metre, 0.324, 0.86},
    {"3 found within 2.0 m", &PublishedScores::false_negatives, within<4>, 0.913}};

EvaluationTable published_table(const Evaluation& evaluation) {
  Table table{{"scene", "evaluation", "the paper", "pushbroom", "pushbroom, original", "random, here",
               "random, the paper"}};
  const auto add = [&](const EvaluationSum& sum) {
    for (const PublishedRow& row : published_rows) {
      if (row.needs_poses() && !evaluation.has_poses) continue;
      std::vector<std::string> cells{sum.name, row.what, percent(row.paper)};
      for (const PublishedScores& scores : sum.published)
        cells.push_back(percent(row.figure(scores.*row.histogram)));
      cells.push_back(row.papers_random ? percent(*row.papers_random) : "-");
      table.rows.push_back(std::move(cells));
    }
  };
  constexpr std::size_t few = 3;  // of more scenes only the sum, or nobody would read it
  if (evaluation.scenes.size() > 1 && evaluation.scenes.size() <= few)
    for (const EvaluationSum& scene : evaluation.scenes) add(scene);
  add(evaluation.all);
  return {"paper", "The paper's evaluations, StereoBM as truth; percent", std::move(table)};
}

EvaluationTable agreement_table(const Evaluation& evaluation) {
  Table table{{"algorithm", "detections/frame", "confirmed by StereoBM, %", "of StereoBM's blocks found, %",
               "confirmed by StereoSGBM, %", "of StereoSGBM's blocks found, %"}};
  const EvaluationSum& all = evaluation.all;
  for (std::size_t i = 0; i < all.algorithms.size(); ++i) {
    if (i == algorithm::true_depth) continue;
    table.add(all.algorithms[i], per_frame(all.hits[i], all, 1));
    for (const std::vector<Rates>& rates : all.agreement)
      for (const Share& share : {rates[i].precision, rates[i].recall})
        table.rows.back().push_back(share.of > 0 ? percent(share.value()) : "-");
  }
  return {"agreement", "Agreement with full stereo, which is no truth, at one pixel", std::move(table)};
}

EvaluationTable algorithms_table(const Evaluation& evaluation) {
  Table table{{"algorithm", "detections/frame", "precision 0.25 m", "0.50 m", "1.00 m", "one pixel",
               "trunk precision", "recall 0.25 m", "0.50 m", "1.00 m", "one pixel", "F", "false/s",
               "found 1 m", "found 3 m", "ms/frame"}};
  const EvaluationSum& all = evaluation.all;
  for (std::size_t i = 0; i < all.algorithms.size(); ++i) {
    const VisionTally& tally = all.tallies[i];
    std::vector<std::string> row{all.algorithms[i], per_frame(all.hits[i], all, 1)};
    for (const Rates& rates : tally.rates) row.push_back(share_text(rates.precision));
    row.push_back(share_text(tally.at_one_pixel().trunk_precision));
    for (const Rates& rates : tally.rates) row.push_back(share_text(rates.recall));
    const bool is_known = tally.at_one_pixel().precision.of + tally.at_one_pixel().recall.of > 0;
    row.push_back(is_known ? number_text(tally.at_one_pixel().f_score(), 3) : "-");
    row.push_back(number_text(tally.false_per_second(), 0));
    for (const double reach_m : {1.0, 3.0})
      row.push_back(share_text(found_within(all.sightings[i], reach_m)));
    row.push_back(is_computed(i) ? number_text(quantile(all.cost_ms[i], 0.5), 3) : "-");
    table.rows.push_back(std::move(row));
  }
  return {"algorithms",
          "Against the truth, each at blocks within one pixel of the detection depth; cost on one thread",
          std::move(table)};
}

EvaluationTable intervals_table(const Evaluation& evaluation) {
  Table table{{"algorithm", "precision", "recall", "found within 1 m", "found within 3 m"}};
  for (const std::size_t i : compared(evaluation.all))
    table.add(evaluation.all.algorithms[i], resampled_text(evaluation, i, &Rates::precision),
              resampled_text(evaluation, i, &Rates::recall),
              wilson_text(found_within(evaluation.all.sightings[i], 1)),
              wilson_text(found_within(evaluation.all.sightings[i], 3)));
  return {"intervals",
          "With 95 % intervals: precision and recall at one pixel by drawing recordings anew, "
          "obstacles after Wilson",
          std::move(table)};
}

EvaluationTable scenes_table(const Evaluation& evaluation) {
  Table table{{"scene", "algorithm", "recordings", "s", "detections/frame", "precision", "recall", "false/s",
               "found 1 m", "of", "found 3 m", "of", "hidden"}};
  for_each_scene(evaluation, [&](const EvaluationSum& sum) {
    for (const std::size_t i : followed(sum)) {
      std::int64_t hidden = 0;
      const Share near = found_within(sum.sightings[i], 1), far = found_within(sum.sightings[i], 3, &hidden);
      const VisionTally& tally = sum.tallies[i];
      table.add(sum.name, sum.algorithms[i], sum.recordings, number_text(sum.seconds, 1),
                per_frame(sum.hits[i], sum, 1), share_text(tally.at_one_pixel().precision),
                share_text(tally.at_one_pixel().recall), number_text(tally.false_per_second(), 0),
                share_text(near), near.of, share_text(far), far.of, hidden);
    }
  });
  return {"scenes", "Every scene, at one pixel", std::move(table)};
}

EvaluationTable computer_table(const Evaluation& evaluation) {
  Table table{{"algorithm", "frames/s", "precision", "found within 1 m", "found within 3 m"}};
  const EvaluationSum& all = evaluation.all;
  for (const std::size_t i : compared(all)) {
    const PacedResult& paced = all.paced[i];
    table.rows.push_back(
        {all.algorithms[i],
         number_text(all.seconds > 0 ? static_cast<double>(paced.frames) / all.seconds : 0, 1),
         share_text(all.tallies[i].at_one_pixel().precision), wilson_text(found_within(paced.sightings, 1)),
         wilson_text(found_within(paced.sightings, 3))});
  }
  return {"computer",
          "On the aircraft's computer (perception.compute), each at the frame rate that it can hold: "
          "obstacles with 95 % intervals after Wilson",
          std::move(table)};
}

EvaluationTable on_the_path_table(const Evaluation& evaluation) {
  Table table{{"algorithm", "obstacles", "found", "detections each, median", "lowest tenth",
               "first detection at, m, median", "third detection at, m, median"}};
  for (std::size_t i = 0; i < evaluation.all.algorithms.size(); ++i) {
    Share found;
    std::vector<double> hits, first_m, third_m;
    for (const ObstacleSighting& sighting : evaluation.all.sightings[i]) {
      if (!sighting.on_the_path || sighting.hidden()) continue;
      found.count(sighting.found());
      hits.push_back(sighting.hits);
      if (sighting.hits >= 1) first_m.push_back(sighting.first_hit_m);
      if (sighting.found()) third_m.push_back(sighting.third_hit_m);
    }
    const auto part = [](const std::vector<double>& values, double q, int decimals) {
      return values.empty() ? "-" : number_text(quantile(values, q), decimals);
    };
    table.add(evaluation.all.algorithms[i], found.of, share_text(found), part(hits, 0.5, 0),
              part(hits, 0.1, 0), part(first_m, 0.5, 2), part(third_m, 0.5, 2));
  }
  return {"on_the_path", "Obstacles that a wing would touch, straight on from where they came into view",
          std::move(table)};
}

EvaluationTable parts_table(const Evaluation& evaluation) {
  Table table{{"algorithm", "by", "part", "detections", "precision", "blocks", "recall"}};
  for (const std::size_t i : followed(evaluation.all))
    for (const auto& [name, bins] : evaluation.all.tallies[i].parts)
      for (const auto& [bin, rates] : bins) {
        const std::size_t space = bin.find(' ');  // behind the number that sorts
        const bool numbered = name != "kind" && space != std::string::npos;
        table.add(evaluation.all.algorithms[i], name, numbered ? bin.substr(space + 1) : bin,
                  rates.precision.of, share_text(rates.precision), rates.recall.of, share_text(rates.recall));
      }
  return {"parts", "By parts, at one pixel", std::move(table)};
}

EvaluationTable false_hits_table(const Evaluation& evaluation) {
  const EvaluationSum& all = evaluation.all;
  const std::vector<std::size_t> places = compared(all);
  Table table{{"on"}};
  std::map<std::string, std::vector<double>> per_second;
  for (std::size_t column = 0; column < places.size(); ++column) {
    table.head.push_back(all.algorithms[places[column]]);
    for (const auto& [what, times] : all.tallies[places[column]].false_on) {
      per_second[what].resize(places.size());
      per_second[what][column] = all.seconds > 0 ? static_cast<double>(times) / all.seconds : 0;
    }
  }
  for (const auto& [what, rates] : per_second) {
    std::vector<std::string>& row = table.rows.emplace_back(1, what);
    for (const double rate : rates) row.push_back(number_text(rate, 1));
  }
  return {"false_positives", "What false positives lie on: how many a second, at one pixel",
          std::move(table)};
}

EvaluationTable disparities_table(const Evaluation& evaluation) {
  Table table{{"algorithm", "matched, %", "bad-1, %", "bad-2, %", "bad-4, %", "end-point error, px"}};
  const EvaluationSum& all = evaluation.all;
  for (std::size_t i = 0; i < all.algorithms.size(); ++i) {
    const DisparityErrors& errors = all.disparities[i];
    if (errors.true_pixels == 0) continue;
    const auto share = [](std::int64_t part, std::int64_t of) {
      return of > 0 ? percent(static_cast<double>(part) / static_cast<double>(of)) : "-";
    };
    table.add(all.algorithms[i], share(errors.matched, errors.true_pixels),
              share(errors.bad_1, errors.matched), share(errors.bad_2, errors.matched),
              share(errors.bad_4, errors.matched),
              errors.matched > 0 ? number_text(errors.sum_px / static_cast<double>(errors.matched), 3) : "-");
  }
  return {"disparities",
          "Disparities of every pixel that has a true depth: share matched; of these, off by more than 1, 2 "
          "and 4 px, and the mean error",
          std::move(table)};
}

EvaluationTable invariance_table(const Evaluation& evaluation) {
  Table table{{"scene", "parameters", "filter", "detections/frame", "precision", "recall", "false/frame"}};
  for_each_scene(evaluation, [&](const EvaluationSum& sum) {
    for (const InvarianceRow& row : sum.invariance)
      table.add(sum.name, row.parameters, row.filter ? "on" : "off", per_frame(row.hits, sum, 2),
                share_text(row.rates.precision), share_text(row.rates.recall),
                per_frame(row.rates.precision.of - row.rates.precision.with, sum, 2));
  });
  return {"invariance", "Horizontal-invariance filter off and on, at one pixel", std::move(table)};
}

}  // namespace

std::vector<EvaluationTable> evaluation_tables(const Evaluation& evaluation) {
  std::vector<EvaluationTable> tables{published_table(evaluation)};
  if (evaluation.has_depth) {
    tables.push_back(algorithms_table(evaluation));
    tables.push_back(intervals_table(evaluation));
    tables.push_back(scenes_table(evaluation));
    if (evaluation.has_objects) {
      tables.push_back(computer_table(evaluation));
      tables.push_back(on_the_path_table(evaluation));
    }
    tables.push_back(parts_table(evaluation));
    tables.push_back(false_hits_table(evaluation));
    tables.push_back(disparities_table(evaluation));
  } else {
    tables.push_back(agreement_table(evaluation));
  }
  tables.push_back(invariance_table(evaluation));
  return tables;
}

Table obstacles_table(const Evaluation& evaluation) {
  Table table{{"recording", "algorithm", "object", "name", "kind", "miss_m", "on_the_path", "hidden",
               "blocks_in_view", "hits", "first_hit_m", "third_hit_m"}};
  for (const RecordingEvaluation& recording : evaluation.recordings)
    for (const std::size_t i : followed(recording.sum))
      for (const ObstacleSighting& sighting : recording.sum.sightings[i]) {
        const auto object = std::ranges::find(recording.objects, sighting.object, &RecordedObject::number);
        table.add(recording.folder.filename().string(), recording.sum.algorithms[i], sighting.object,
                  object->name, object->kind, number_text(sighting.miss_m, 3),
                  sighting.on_the_path ? "1" : "0", sighting.hidden() ? "1" : "0", sighting.blocks_in_view,
                  sighting.hits, number_text(sighting.first_hit_m, 3), number_text(sighting.third_hit_m, 3));
      }
  return table;
}

}  // namespace understory
