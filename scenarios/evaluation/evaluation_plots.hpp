#pragma once

#include <string>

#include "scenarios/evaluation/evaluation.hpp"

namespace understory {

/// Precision over recall of every algorithm as its threshold varies, SVG. Needs true depth.
std::string precision_recall_plot(const Evaluation& evaluation);

/// The paper's three histograms of distance, ours and random's, SVG.
std::string distances_plot(const Evaluation& evaluation);

/// How often an obstacle's block has a hit, over its true distance: every algorithm's response, SVG.
std::string response_plot(const Evaluation& evaluation);

/// The depth at which obstacles within 3 m of the path had their first and their third hit, SVG.
std::string first_hits_plot(const Evaluation& evaluation);

}  // namespace understory
