#include "scenarios/evaluation/evaluation_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "scenarios/evaluation/evaluation_recording.hpp"
#include "scenarios/report/line_plot.hpp"

namespace understory {
namespace {

constexpr int scale = 3, heat_scale = 6, title_px = 22;
constexpr std::size_t maximum_worst = 12;
const cv::Scalar true_positive_colour(80, 200, 60), false_positive_colour(40, 40, 235),
    missed_colour(60, 220, 240), text_colour(240, 240, 240);

void write_line(cv::Mat& picture, const std::string& text, cv::Point place) {
  cv::putText(picture, text, place, cv::FONT_HERSHEY_SIMPLEX, 0.5, text_colour, 1, cv::LINE_AA);
}

cv::Mat heat_map(const std::vector<std::int64_t>& counts, int columns, const std::string& title) {
  const int rows = static_cast<int>(counts.size()) / columns;
  const std::int64_t most = std::max<std::int64_t>(1, *std::ranges::max_element(counts));
  cv::Mat small(rows, columns, CV_8UC1);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      small.at<std::uint8_t>(row, column) = static_cast<std::uint8_t>(
          255 * std::sqrt(static_cast<double>(counts[static_cast<std::size_t>(row * columns + column)]) /
                          static_cast<double>(most)));
  cv::Mat large, coloured;
  cv::resize(small, large, {}, heat_scale, heat_scale, cv::INTER_NEAREST);
  cv::applyColorMap(large, coloured, cv::COLORMAP_INFERNO);
  cv::copyMakeBorder(coloured, coloured, title_px, 4, 4, 4, cv::BORDER_CONSTANT, cv::Scalar(40, 40, 40));
  write_line(coloured, fmt::format("{}: {} at most in a block", title, most), {6, 16});
  return coloured;
}

std::vector<double> in_percent(const DistanceHistogram& histogram, std::vector<double>& x_m) {
  std::vector<double> percent;
  const double total = static_cast<double>(std::max<std::int64_t>(1, histogram.total()));
  for (std::size_t i = 0; i < DistanceHistogram::bin_count; ++i) {
    x_m.push_back((static_cast<double>(i) + 0.5) * DistanceHistogram::bin_m);
    percent.push_back(100 * static_cast<double>(histogram.bins[i]) / total);
  }
  return percent;
}

LinePlot histogram_panel(const char* title, const Evaluation& evaluation,
                         const DistanceHistogram PublishedScores::*histogram) {
  LinePlot plot{title, "distance, m (the last: 10 m and more)", "% per half metre"};
  for (std::size_t i = 0; i < published_algorithms.size(); ++i) {
    Series series{.name = algorithm_names[published_algorithms[i]], .mark = Mark::line_and_dots};
    series.y = in_percent(evaluation.all.published[i].*histogram, series.x);
    plot.series.push_back(series);
  }
  return plot;
}

/// Share of the obstacles found so far, from far to near.
Series reached(const char* name, std::vector<double> depths_m, std::size_t of) {
  std::ranges::sort(depths_m, std::ranges::greater{});
  Series series{.name = name, .mark = Mark::line};
  for (std::size_t i = 0; i < depths_m.size(); ++i) {
    series.x.push_back(depths_m[i]);
    series.y.push_back(100 * static_cast<double>(i + 1) / static_cast<double>(of));
  }
  return series;
}

}  // namespace

cv::Mat heat_maps(const VisionTally& tally, const char* title) {
  cv::Mat all;
  cv::hconcat(
      std::vector<cv::Mat>{
          heat_map(tally.true_positives_at, tally.columns, std::string(title) + ", true positives"),
          heat_map(tally.false_positives_at, tally.columns, std::string(title) + ", false positives"),
          heat_map(tally.expected_at, tally.columns, "obstacles at the depth")},
      all);
  return all;
}

cv::Mat annotated_frame(const EvaluationFrame& frame, const DetectionGrid& grid,
                        const std::vector<StereoHit>& hits) {
  cv::Mat picture;
  cv::cvtColor(frame.pair.left, picture, cv::COLOR_GRAY2BGR);
  cv::resize(picture, picture, {}, scale, scale, cv::INTER_NEAREST);
  const auto draw = [&](int column_px, int row_px, const cv::Scalar& colour, int thickness) {
    cv::rectangle(picture,
                  cv::Rect(scale * column_px, scale * row_px, scale * truth_block_px, scale * truth_block_px),
                  colour, thickness);
  };
  std::vector<bool> found(static_cast<std::size_t>(grid.block_count()));
  for (const StereoHit& hit : hits)
    if (const int block = grid.block_of(hit); block >= 0) found[static_cast<std::size_t>(block)] = true;
  int missed = 0, false_positives = 0;
  for (const ExpectedBlock& block : expected_blocks(frame.truth, grid)) {
    if (found[static_cast<std::size_t>(block.block)]) continue;
    ++missed;
    draw(block.block % grid.columns * truth_block_px, block.block / grid.columns * truth_block_px,
         missed_colour, 1);
  }
  for (const StereoHit& hit : hits) {
    const bool is_true = true_within(hit, frame.truth, grid)[one_pixel];
    false_positives += !is_true;
    draw(hit.column_px, hit.row_px, is_true ? true_positive_colour : false_positive_colour, 2);
  }
  write_line(picture,
             fmt::format("{} true positives (green), {} false positives (red), {} false negatives (yellow)",
                         static_cast<int>(hits.size()) - false_positives, false_positives, missed),
             {8, picture.rows - 10});
  return picture;
}

std::vector<WorstPicture> worst_pictures(const Evaluation& evaluation) {
  const PushbroomConfig& rule = evaluation.settings.pushbroom();
  const std::vector<std::size_t> places = followed(evaluation.all);
  std::vector<WorstPicture> pictures;
  for (std::size_t place = 0; place < places.size(); ++place) {
    const std::string& name = evaluation.all.algorithms[places[place]];
    std::vector<std::pair<WorstFrame, const RecordingEvaluation*>> all;
    for (const RecordingEvaluation& recording : evaluation.recordings)
      if (place < recording.worst.size())
        for (const WorstFrame& frame : recording.worst[place]) all.emplace_back(frame, &recording);
    std::ranges::stable_sort(all, std::ranges::greater{},
                             [](const auto& one) { return one.first.false_hits; });
    all.resize(std::min(all.size(), maximum_worst));
    for (const auto& [worst, recording] : all) {
      EvaluationRecording source(recording->folder);
      const DetectionGrid grid(recording->rig, stated_depths_m(rule, recording->rig), rule.last_row_px);
      cv::Mat picture = annotated_frame(source.frame(worst.index), grid, worst.hits);
      const std::string caption =
          fmt::format("{}, {}, frame {}", name, recording->folder.filename().string(), worst.index);
      write_line(picture, caption, {8, 18});
      pictures.push_back({name, fmt::format("{}: {} false positives", caption, worst.false_hits), picture});
    }
  }
  return pictures;
}

LinePlot precision_recall_plot(const Evaluation& evaluation) {
  const DetectionDepth& depth = evaluation.recordings.front().detection_depth;
  LinePlot plot{fmt::format("{:.2f} m, one pixel ({:.2f} to {:.2f} m), {} frames", depth.depth_m,
                            depth.one_pixel.near_m, depth.one_pixel.far_m, evaluation.all.frames),
                "recall, %", "precision, %"};
  for (const PrecisionRecallCurve& curve : evaluation.all.curves) {
    Series series{.name = curve.algorithm + " over " + curve.threshold, .mark = Mark::line_and_dots};
    for (const auto& [threshold, rates] : curve.points) {
      if (rates.precision.of == 0) continue;
      series.x.push_back(100 * rates.recall.value());
      series.y.push_back(100 * rates.precision.value());
    }
    plot.series.push_back(series);
  }
  return plot;
}

std::vector<LinePlot> distances_plots(const Evaluation& evaluation) {
  std::vector<LinePlot> panels{histogram_panel("1: single frames, to StereoBM near the depth", evaluation,
                                               &PublishedScores::single_frame)};
  if (evaluation.has_poses) {
    panels.push_back(histogram_panel("2: from remembered points to StereoBM", evaluation,
                                     &PublishedScores::false_positives));
    panels.push_back(histogram_panel("3: from StereoBM to remembered points", evaluation,
                                     &PublishedScores::false_negatives));
  }
  return panels;
}

LinePlot response_plot(const Evaluation& evaluation) {
  constexpr double bin_m = 0.5;
  LinePlot plot{"Recall over the true distance of the blocks", "true distance, m", "recall, %"};
  for (std::size_t i = 0; i < evaluation.all.algorithms.size(); ++i) {
    if (!is_computed(i)) continue;
    Series series{.name = evaluation.all.algorithms[i], .mark = Mark::line};
    const std::vector<Share>& response = evaluation.all.tallies[i].response;
    for (std::size_t bin = 0; bin < response.size(); ++bin) {
      if (response[bin].of < 20) continue;
      series.x.push_back((static_cast<double>(bin) + 0.5) * bin_m);
      series.y.push_back(100 * response[bin].value());
    }
    plot.series.push_back(series);
  }
  plot.references.push_back({evaluation.recordings.front().detection_depth.depth_m, "detection depth", true});
  return plot;
}

LinePlot first_hits_plot(const Evaluation& evaluation) {
  LinePlot plot{"Obstacles within 3 m of the path: found by then", "true distance, m", "% of obstacles"};
  std::vector<std::size_t> places{algorithm::our_rule, algorithm::the_papers_rule, algorithm::stereo_bm};
  for (std::size_t i = algorithm_count; i < evaluation.all.algorithms.size(); ++i) places.push_back(i);
  for (const std::size_t i : places) {
    std::vector<double> first_m, third_m;
    std::size_t of = 0;
    for (const ObstacleSighting& sighting : evaluation.all.sightings[i]) {
      if (sighting.miss_m > 3 || sighting.hidden()) continue;
      ++of;
      if (sighting.hits >= 1) first_m.push_back(sighting.first_hit_m);
      if (sighting.found()) third_m.push_back(sighting.third_hit_m);
    }
    if (of == 0) continue;
    const std::string& name = evaluation.all.algorithms[i];
    plot.series.push_back(reached((name + ", first detection").c_str(), first_m, of));
    plot.series.push_back(reached((name + ", third").c_str(), third_m, of));
    plot.series.back().mark = Mark::dashes;
    plot.series.back().colour = plot.series[plot.series.size() - 2].colour =
        static_cast<int>(plot.series.size()) / 2 - 1;
  }
  return plot;
}

}  // namespace understory
