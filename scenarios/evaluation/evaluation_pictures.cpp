#include "scenarios/evaluation/evaluation_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "scenarios/report/picture_folder.hpp"

namespace understory {
namespace {

constexpr int scale = 3, heat_scale = 6, worst_pictures = 12, title_px = 22;
const cv::Scalar true_positive_colour(80, 200, 60), false_positive_colour(40, 40, 235),
    missed_colour(60, 220, 240), text_colour(240, 240, 240);

void write_line(cv::Mat& picture, const std::string& text, cv::Point place) {
  cv::putText(picture, text, place, cv::FONT_HERSHEY_SIMPLEX, 0.5, text_colour, 1, cv::LINE_AA);
}

cv::Mat heat_map(const std::vector<std::int64_t>& counts, int columns, const std::string& title) {
  const int rows = static_cast<int>(counts.size()) / columns;
  const std::int64_t maximum = std::max<std::int64_t>(1, *std::ranges::max_element(counts));
  cv::Mat small(rows, columns, CV_8UC1);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      small.at<std::uint8_t>(row, column) = static_cast<std::uint8_t>(
          255 * std::sqrt(static_cast<double>(counts[static_cast<std::size_t>(row * columns + column)]) /
                          static_cast<double>(maximum)));
  cv::Mat large, coloured;
  cv::resize(small, large, {}, heat_scale, heat_scale, cv::INTER_NEAREST);
  cv::applyColorMap(large, coloured, cv::COLORMAP_INFERNO);
  cv::copyMakeBorder(coloured, coloured, title_px, 4, 4, 4, cv::BORDER_CONSTANT, cv::Scalar(40, 40, 40));
  write_line(coloured, fmt::format("{}: {} at most in a block", title, maximum), {6, 16});
  return coloured;
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

cv::Mat annotated_frame(const EvaluationFrame& frame, const StereoRig& rig, const PushbroomConfig& rule) {
  const DetectionGrid grid(rig, rule.depths_m, rule.last_row_px);
  PushbroomStereo detector(rig, rule);
  const std::vector<StereoHit>& hits = detector.detect(frame.pair);
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
    const bool is_true = judge(hit, frame.truth, grid)[one_pixel];
    false_positives += !is_true;
    draw(hit.column_px, hit.row_px, is_true ? true_positive_colour : false_positive_colour, 2);
  }
  write_line(picture,
             fmt::format("{} true positives (green), {} false (red), {} due blocks without a hit (yellow)",
                         static_cast<int>(hits.size()) - false_positives, false_positives, missed),
             {8, picture.rows - 10});
  return picture;
}

void write_worst_frames(const Evaluation& evaluation, const std::filesystem::path& folder) {
  std::vector<std::pair<WorstFrame, const RecordingEvaluation*>> all;
  for (const RecordingEvaluation& recording : evaluation.recordings)
    for (const WorstFrame& frame : recording.worst) all.emplace_back(frame, &recording);
  std::ranges::stable_sort(all, std::ranges::greater{}, [](const auto& one) { return one.first.false_hits; });
  all.resize(std::min<std::size_t>(all.size(), worst_pictures));
  PictureFolder pictures(folder);
  for (const auto& [worst, recording] : all) {
    EvaluationRecording source(recording->folder);
    cv::Mat picture = annotated_frame(source.frame(worst.index), recording->rig, evaluation.settings.rule);
    write_line(picture, fmt::format("{}, frame {}", recording->folder.filename().string(), worst.index),
               {8, 18});
    pictures.add(picture);
  }
  pictures.finish();
}

}  // namespace understory
