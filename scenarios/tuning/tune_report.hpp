#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/report/line_plot.hpp"
#include "scenarios/report/table.hpp"
#include "scenarios/tuning/tuning.hpp"

namespace understory {

/// Whether the search found anything better than the scenario as it is, on training data; always true if
/// there are several goals.
bool gains(const TuneFile& file, const Tuned& tuned);

/// The scenario as it is and tuned, on training and on validation data: a row a figure.
Table comparison_table(const TuneFile& file, const Tuned& tuned);

/// summary.md: what was tuned, comparison, front, sensitivities, the keys.
std::string tune_summary(const TuneFile& file, const Tuned& tuned);

/// Writes trials.csv, pareto.csv, summary.md, tune.svg, front/trial-N.yaml, report.html, a page of all that,
/// and, where the search gains anything, best.yaml: the tuned keys as `fly --with` reads them, with figures
/// as comments. `data_root` holds scenarios/report/page.
void write_tune_report(const std::filesystem::path& folder, const TuneFile& file, const Tuned& tuned,
                       const std::filesystem::path& data_root);

/// The first goal's figure over the figure it is traded against (the next goal's, else a limit's): every
/// trial, the front, the scenario as it is, the tuned one; on training and validation data. If there is
/// nothing to trade, the goal's figure over the trials.
LinePlot pareto_plot(const TuneFile& file, const Tuned& tuned);

/// A panel for each parameter: goals and limited figures as it alone varies.
std::vector<LinePlot> sensitivity_plots(const TuneFile& file, const Tuned& tuned);

/// All of them as one SVG document.
std::string tune_svg(const TuneFile& file, const Tuned& tuned);

}  // namespace understory
