#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "scenarios/evaluation/evaluation.hpp"
#include "scenarios/report/line_plot.hpp"
#include "scenarios/report/table.hpp"

namespace understory {

/// What was evaluated, and every table, for a terminal.
std::string evaluation_report(const Evaluation& evaluation);

/// Into `folder`: summary.md, evaluation.json (every figure), tables/*.csv, obstacles.csv,
/// precision_recall.svg, distances.svg, response.svg, first_hits.svg, heat_map.png (ours),
/// heat_map_paper.png, worst/, and report.html, a page of all that; files that need a truth that no recording
/// has are left out. `data_root` holds scenarios/report/page. Throws ScenarioError or MachineError where it
/// cannot be written.
void write_evaluation(const Evaluation& evaluation, const std::filesystem::path& folder,
                      const std::filesystem::path& data_root);

/// A table with its name, as a file's name and as a title.
struct EvaluationTable {
  std::string file;   ///< "algorithms"
  std::string title;  ///< one line
  Table table;        ///< cells are plain numbers or words; units stand in the head
};

/// All tables that the recordings allow, in the order in which people read them: against the paper's figures,
/// all algorithms, scenes, obstacles passed, parts, false hits, invariance.
std::vector<EvaluationTable> evaluation_tables(const Evaluation& evaluation);

/// A line per obstacle passed and algorithm of followed(): how it was detected.
Table obstacles_table(const Evaluation& evaluation);

/// Where in the image true positives, false positives and due blocks lie, side by side, each as bright as its
/// own fullest block; BGR, with titles.
cv::Mat heat_maps(const VisionTally& tally, const char* title);

/// A frame, three times as large: true positives green, false positives red, due blocks without a hit thin
/// yellow. BGR.
cv::Mat annotated_frame(const EvaluationFrame& frame, const DetectionGrid& grid,
                        const std::vector<StereoHit>& hits);

/// The worst of all recordings for each of followed(), annotated, with a caption each. Throws as
/// EvaluationRecording does.
struct WorstPicture {
  std::string algorithm;
  std::string caption;
  cv::Mat picture;  ///< BGR
};
std::vector<WorstPicture> worst_pictures(const Evaluation& evaluation);

/// Precision over recall of every algorithm as its threshold varies. Needs true depth.
LinePlot precision_recall_plot(const Evaluation& evaluation);

/// The paper's three histograms of distance, ours and random's.
std::vector<LinePlot> distances_plots(const Evaluation& evaluation);

/// How often an obstacle's block has a hit, over its true distance: every algorithm's response.
LinePlot response_plot(const Evaluation& evaluation);

/// The depth at which obstacles within 3 m of the path had their first and their third hit.
LinePlot first_hits_plot(const Evaluation& evaluation);

}  // namespace understory
