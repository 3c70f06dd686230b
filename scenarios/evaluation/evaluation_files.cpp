#include "scenarios/evaluation/evaluation_report.hpp"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "perception/io/picture_codecs.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/report/pictures.hpp"
#include "scenarios/report/sheet_page.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// What the recordings lack, and the tables that are missing for it.
std::string lacking(const Evaluation& evaluation) {
  std::string text;
  if (!evaluation.has_depth)
    text +=
        "No true depth (depth0): precision, recall, false detections and errors of disparities are not "
        "known.\n";
  else if (!evaluation.has_objects)
    text += "No objects (objects0): obstacles found and kinds of surfaces are not known.\n";
  if (!evaluation.has_poses)
    text +=
        "No poses (state_groundtruth_estimate0 or mocap0): the paper's evaluations 2 and 3, which remember "
        "points, cannot be made.\n";
  return text;
}

std::string heading(const Evaluation& evaluation) {
  const RecordingEvaluation& first = evaluation.recordings.front();
  return fmt::format(
             "{} recording{}, {} frames, {:.1f} s; rig {}, looking {:.2f} m ahead, one pixel is "
             "{:.2f} to {:.2f} m\n",
             evaluation.recordings.size(), evaluation.recordings.size() == 1 ? "" : "s",
             evaluation.all.frames, evaluation.all.seconds, one_line(first.rig.name),
             first.detection_depth.depth_m, first.detection_depth.one_pixel.near_m,
             first.detection_depth.one_pixel.far_m) +
         lacking(evaluation);
}

/// What the figures say, before anything else.
std::string sentence_of(const Evaluation& evaluation) {
  if (!evaluation.has_depth)
    return "These recordings have no true depth: StereoBM stands in for it, as in the paper. ";
  const EvaluationSum& all = evaluation.all;
  std::vector<std::size_t> places = followed(all);
  places.insert(places.begin() + 1, algorithm::stereo_bm);
  std::vector<std::string> words;
  for (const std::size_t i : places) {
    const Rates& rates = all.tallies[i].at_one_pixel();
    words.push_back(fmt::format("{} {:.1f} and {:.1f} %", all.algorithms[i], 100 * rates.precision.value(),
                                100 * rates.recall.value()));
  }
  return fmt::format("Detections that are true, and blocks of obstacles that are found: {}. ",
                     fmt::join(words, ", "));
}

Json to_json(const Share& share) {
  return {{"of", share.of}, {"with", share.with}, {"share", share.value()}};
}

Json to_json(const Rates& rates) {
  return {{"precision", to_json(rates.precision)}, {"recall", to_json(rates.recall)}};
}

Json to_json(const DistanceHistogram& histogram) {
  return {{"bin_m", DistanceHistogram::bin_m},
          {"bins", histogram.bins},
          {"no_match", histogram.no_match},
          {"within_0.5_m", histogram.share_within(0.5)},
          {"within_1.0_m", histogram.share_within(1)},
          {"within_2.0_m", histogram.share_within(2)}};
}

Json algorithm_json(const EvaluationSum& sum, std::size_t index) {
  const VisionTally& tally = sum.tallies[index];
  std::int64_t hidden = 0;
  const Share near = found_within(sum.sightings[index], 1),
              far = found_within(sum.sightings[index], 3, &hidden);
  Json json{{"name", sum.algorithms[index]}, {"hits", sum.hits[index]}};
  for (std::size_t i = 0; i < tolerance_count; ++i) {
    json["precision"][tolerance_names[i]] = to_json(tally.rates[i].precision);
    json["recall"][tolerance_names[i]] = to_json(tally.rates[i].recall);
  }
  json["trunk_precision"] = to_json(tally.at_one_pixel().trunk_precision);
  json["f_score"] = tally.at_one_pixel().f_score();
  json["false_per_second"] = tally.false_per_second();
  json["false_on"] = tally.false_on;
  json["found_within_1_m"] = to_json(near);
  json["found_within_3_m"] = to_json(far);
  json["hidden_within_3_m"] = hidden;
  if (is_computed(index)) json["median_ms"] = quantile(sum.cost_ms[index], 0.5);
  if (const DisparityErrors& errors = sum.disparities[index]; errors.true_pixels > 0)
    json["disparities"] = {{"true_pixels", errors.true_pixels},
                           {"matched", errors.matched},
                           {"bad_1", errors.bad_1},
                           {"bad_2", errors.bad_2},
                           {"bad_4", errors.bad_4},
                           {"end_point_error_px",
                            errors.sum_px / static_cast<double>(std::max<std::int64_t>(1, errors.matched))}};
  for (const auto& [name, bins] : tally.parts)
    for (const auto& [bin, rates] : bins) json["parts"][name][bin] = to_json(rates);
  return json;
}

Json sum_json(const EvaluationSum& sum) {
  Json json{
      {"name", sum.name}, {"recordings", sum.recordings}, {"frames", sum.frames}, {"seconds", sum.seconds}};
  for (std::size_t i = 0; i < sum.algorithms.size(); ++i)
    json["algorithms"].push_back(algorithm_json(sum, i));
  for (std::size_t i = 0; i < sum.algorithms.size(); ++i)
    if (is_computed(i))
      json["computer"].push_back({{"name", sum.algorithms[i]},
                                  {"frames", sum.paced[i].frames},
                                  {"found_within_1_m", to_json(found_within(sum.paced[i].sightings, 1))},
                                  {"found_within_3_m", to_json(found_within(sum.paced[i].sightings, 3))}});
  for (std::size_t i = 0; i < published_algorithms.size(); ++i)
    json["paper"].push_back({{"name", algorithm_names[published_algorithms[i]]},
                             {"single_frame", to_json(sum.published[i].single_frame)},
                             {"false_positives", to_json(sum.published[i].false_positives)},
                             {"false_negatives", to_json(sum.published[i].false_negatives)}});
  for (std::size_t j = 0; j < sum.agreement.size(); ++j)
    for (std::size_t i = 0; i < sum.algorithms.size(); ++i)
      if (const Rates& rates = sum.agreement[j][i]; rates.precision.of > 0)
        json["agreement"][algorithm_names[algorithm::stereo_bm + j]][sum.algorithms[i]] = to_json(rates);
  for (const InvarianceRow& row : sum.invariance) {
    json["invariance"].push_back(
        {{"parameters", row.parameters}, {"filter", row.filter}, {"hits", row.hits}});
    json["invariance"].back().update(to_json(row.rates));
  }
  for (const PrecisionRecallCurve& curve : sum.curves) {
    Json points;
    for (const PrecisionRecallCurve::Point& point : curve.points) {
      points.push_back({{"threshold", point.threshold}});
      points.back().update(to_json(point.rates));
    }
    json["curves"].push_back({{"name", curve.algorithm}, {"threshold", curve.threshold}, {"points", points}});
  }
  return json;
}

std::string evaluation_json(const Evaluation& evaluation) {
  const RecordingEvaluation& first = evaluation.recordings.front();
  Json json{{"understory", understory_version},
            {"commit", understory_commit},
            {"processor", processor_model()},
            {"rig", first.rig.name},
            {"detection_depth_m", first.detection_depth.depth_m},
            {"one_pixel_m", {first.detection_depth.one_pixel.near_m, first.detection_depth.one_pixel.far_m}},
            {"all", sum_json(evaluation.all)}};
  for (const EvaluationSum& scene : evaluation.scenes) json["scenes"].push_back(sum_json(scene));
  return json_text(json, 1) + "\n";
}

/// Into the folder, and as a part of the page.
SheetSection write_worst_frames(const Evaluation& evaluation, const fs::path& folder) {
  SheetSection section{"The frames with the most false detections"};
  prepare_output_folder(folder);
  std::map<std::string, int> numbers;
  for (const WorstPicture& worst : worst_pictures(evaluation)) {
    write_picture(folder / fmt::format("{}-{:02}.png", worst.algorithm, numbers[worst.algorithm]++),
                  worst.picture);
    const auto jpeg = picture_codecs().encode_jpeg(worst.picture, 85);
    section.pictures.push_back({worst.caption, {jpeg.begin(), jpeg.end()}});
  }
  return section;
}

}  // namespace

std::string evaluation_report(const Evaluation& evaluation) {
  std::string text = heading(evaluation);
  for (const EvaluationTable& table : evaluation_tables(evaluation))
    text += "\n" + table.title + "\n" + to_text(table.table);
  return text;
}

void write_evaluation(const Evaluation& evaluation, const fs::path& folder, const fs::path& data_root) {
  prepare_output_folder(folder);
  prepare_output_folder(folder / "tables");
  std::string summary = "# Evaluation\n\n" + heading(evaluation);
  std::vector<SheetSection> page;
  const auto write_plots = [&](const char* file, const std::vector<LinePlot>& plots) {
    write_whole_file(folder / file, to_svg(plots));
    page.front().plots.insert(page.front().plots.end(), plots.begin(), plots.end());
  };
  page.push_back({"Curves"});
  SheetSection main_table;
  for (const EvaluationTable& table : evaluation_tables(evaluation)) {
    summary += "\n## " + table.title + "\n\n" + to_markdown(table.table);
    write_whole_file(folder / "tables" / (table.file + ".csv"), to_csv(table.table));
    SheetSection section{.title = table.title, .table = table.table};
    if (table.file == (evaluation.has_depth ? "algorithms" : "paper"))
      main_table = std::move(section);
    else
      page.push_back(std::move(section));
  }
  write_whole_file(folder / "evaluation.json", evaluation_json(evaluation));
  if (evaluation.has_depth) {
    write_plots("precision_recall.svg", {precision_recall_plot(evaluation)});
    write_plots("response.svg", {response_plot(evaluation)});
    write_picture(folder / "heat_map.png",
                  heat_maps(evaluation.all.tallies[algorithm::our_rule], "pushbroom"));
    write_picture(folder / "heat_map_paper.png",
                  heat_maps(evaluation.all.tallies[algorithm::the_papers_rule], "pushbroom, original"));
    page.insert(page.begin() + 1, write_worst_frames(evaluation, folder / "worst"));
  }
  if (evaluation.has_objects) {
    write_plots("first_hits.svg", {first_hits_plot(evaluation)});
    write_whole_file(folder / "obstacles.csv", to_csv(obstacles_table(evaluation)));
  }
  write_plots("distances.svg", distances_plots(evaluation));
  write_whole_file(folder / "summary.md", summary);
  page.insert(page.begin(), std::move(main_table));
  write_whole_file(folder / "report.html",
                   sheet_page(data_root, "Evaluation", sentence_of(evaluation) + heading(evaluation), page));
}

}  // namespace understory
