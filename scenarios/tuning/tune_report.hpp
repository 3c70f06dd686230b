#pragma once

#include <filesystem>
#include <string>

#include "scenarios/report/table.hpp"
#include "scenarios/tuning/tuning.hpp"

namespace understory {

/// Whether the search found anything better than the scenario as it is, on training data; taken for granted
/// where there are several goals.
bool gains(const TuneFile& file, const Tuned& tuned);

/// The scenario as it is and tuned, on training and on validation data: a row a figure.
Table comparison_table(const TuneFile& file, const Tuned& tuned);

/// summary.md: what was tuned, comparison, front, sensitivities, the keys.
std::string tune_summary(const TuneFile& file, const Tuned& tuned);

/// Writes trials.csv, pareto.csv, summary.md, tune.svg, front/trial-N.yaml and, where the search gains
/// anything, best.yaml: the tuned keys as `fly --with` reads them, with figures as comments.
void write_tune_report(const std::filesystem::path& folder, const TuneFile& file, const Tuned& tuned);

}  // namespace understory
