#include "scenarios/evaluation/evaluation_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "scenarios/report/line_plot.hpp"

namespace understory {
namespace {

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
  LinePlot plot;
  plot.title = title;
  plot.x_label = "distance, m (the last: 10 m and more)";
  plot.y_label = "% per half metre";
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

std::string precision_recall_plot(const Evaluation& evaluation) {
  LinePlot plot;
  plot.title = fmt::format("Blocks at {:.2f} m, within one pixel ({:.2f} to {:.2f} m)",
                           evaluation.recordings.front().detection_depth_m,
                           evaluation.recordings.front().one_pixel.near_m,
                           evaluation.recordings.front().one_pixel.far_m);
  plot.x_label = "recall, %";
  plot.y_label = "precision, %";
  for (const PrecisionRecallCurve& curve : evaluation.all.curves) {
    Series series{.name = curve.algorithm + " over " + curve.threshold, .mark = Mark::line_and_dots};
    for (const CurvePoint& point : curve.points) {
      if (point.precision.of == 0) continue;
      series.x.push_back(100 * point.recall.value());
      series.y.push_back(100 * point.precision.value());
    }
    plot.series.push_back(series);
  }
  return to_svg({plot});
}

std::string distances_plot(const Evaluation& evaluation) {
  std::vector<LinePlot> panels{histogram_panel("1: single frames, to StereoBM near the depth", evaluation,
                                               &PublishedScores::single_frame)};
  if (evaluation.has_poses()) {
    panels.push_back(histogram_panel("2: from remembered points to StereoBM", evaluation,
                                     &PublishedScores::false_positives));
    panels.push_back(histogram_panel("3: from StereoBM to remembered points", evaluation,
                                     &PublishedScores::false_negatives));
  }
  return to_svg(panels);
}

std::string response_plot(const Evaluation& evaluation) {
  constexpr double bin_m = 0.5;
  LinePlot plot;
  plot.title = "Obstacle blocks with a hit, over their true distance";
  plot.x_label = "true distance, m";
  plot.y_label = "% of blocks";
  for (const std::size_t i : {our_rule, the_papers_rule, stereo_bm, stereo_sgbm}) {
    Series series{.name = algorithm_names[i], .mark = Mark::line};
    const std::vector<Share>& response = evaluation.all.tallies[i].response;
    for (std::size_t bin = 0; bin < response.size(); ++bin) {
      if (response[bin].of < 20) continue;
      series.x.push_back((static_cast<double>(bin) + 0.5) * bin_m);
      series.y.push_back(100 * response[bin].value());
    }
    plot.series.push_back(series);
  }
  plot.references.push_back({evaluation.recordings.front().detection_depth_m, "detection depth", true});
  return to_svg({plot});
}

std::string first_hits_plot(const Evaluation& evaluation) {
  LinePlot plot;
  plot.title = "Obstacles within 3 m of the path: found by then";
  plot.x_label = "true distance, m";
  plot.y_label = "% of obstacles";
  for (const std::size_t i : {our_rule, the_papers_rule, stereo_bm}) {
    std::vector<double> first_m, third_m;
    std::size_t of = 0;
    for (const ObstacleSighting& sighting : evaluation.all.sightings[i]) {
      if (sighting.miss_m > 3 || sighting.hidden()) continue;
      ++of;
      if (sighting.hits >= 1) first_m.push_back(sighting.first_hit_m);
      if (sighting.found()) third_m.push_back(sighting.third_hit_m);
    }
    if (of == 0) continue;
    const std::string name = algorithm_names[i];
    plot.series.push_back(reached((name + ", first hit").c_str(), first_m, of));
    plot.series.push_back(reached((name + ", third").c_str(), third_m, of));
    plot.series.back().mark = Mark::dashes;
    plot.series.back().colour = plot.series[plot.series.size() - 2].colour =
        static_cast<int>(plot.series.size()) / 2 - 1;
  }
  return to_svg({plot});
}

}  // namespace understory
