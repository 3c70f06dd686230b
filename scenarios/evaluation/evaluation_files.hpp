#pragma once

#include <filesystem>
#include <string>

#include "scenarios/evaluation/evaluation.hpp"

namespace understory {

/// What was evaluated, and every table, for a terminal.
std::string evaluation_report(const Evaluation& evaluation);

/// Into `folder`: summary.md, evaluation.json (every figure), tables/*.csv, obstacles.csv,
/// precision_recall.svg, distances.svg, response.svg, first_hits.svg, heat_map.png (ours),
/// heat_map_paper.png, worst/; what needs a truth that no recording has is left out. Throws ScenarioError or
/// MachineError where it cannot be written.
void write_evaluation(const Evaluation& evaluation, const std::filesystem::path& folder);

}  // namespace understory
