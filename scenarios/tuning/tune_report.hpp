#pragma once

#include <filesystem>
#include <string>

#include "scenarios/report/table.hpp"
#include "scenarios/tuning/judge.hpp"
#include "scenarios/tuning/tuning.hpp"

namespace understory {

/// The scenario as it is and tuned, on training and on validation data: a row a figure.
Table comparison_table(const TuneFile& file, const Tuned& tuned, const Judge& validation);

/// summary.md: what was tuned, comparison, front, sensitivities, the keys.
std::string tune_summary(const TuneFile& file, const Tuned& tuned, const Judge& validation);

/// The tuned keys as `fly --with` reads them, with figures as comments.
std::string tuned_config(const TuneFile& file, const JudgedTrial& trial);

/// Writes trials.csv, pareto.csv, summary.md, tune.svg, best.yaml and front/trial-N.yaml.
void write_tune_report(const std::filesystem::path& folder, const TuneFile& file, const Tuned& tuned,
                       const Judge& validation);

}  // namespace understory
