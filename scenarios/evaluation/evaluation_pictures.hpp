#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "scenarios/evaluation/evaluation.hpp"

namespace understory {

/// Where in the image true positives, false positives and due blocks lie, side by side, each as bright as its
/// own fullest block; BGR, with titles.
cv::Mat heat_maps(const VisionTally& tally, const char* title);

/// A frame, three times as large: true positives green, false positives red, due blocks without a hit thin
/// yellow. BGR.
cv::Mat annotated_frame(const EvaluationFrame& frame, const StereoRig& rig, const PushbroomConfig& rule);

/// The worst of all recordings, annotated, as FOLDER/00.png ... Throws as EvaluationRecording does.
void write_worst_frames(const Evaluation& evaluation, const std::filesystem::path& folder);

/// Precision over recall of every algorithm as its threshold varies, SVG. Needs true depth.
std::string precision_recall_plot(const Evaluation& evaluation);

/// The paper's three histograms of distance, ours and random's, SVG.
std::string distances_plot(const Evaluation& evaluation);

/// How often an obstacle's block has a hit, over its true distance: every algorithm's response, SVG.
std::string response_plot(const Evaluation& evaluation);

/// The depth at which obstacles within 3 m of the path had their first and their third hit, SVG.
std::string first_hits_plot(const Evaluation& evaluation);

}  // namespace understory
