#pragma once

#include <string>
#include <vector>

#include "scenarios/report/line_plot.hpp"
#include "scenarios/tuning/tuning.hpp"

namespace understory {

/// The first goal's figure over the figure it is traded against (the next goal's, else a limit's): every
/// trial, the front, the scenario as it is, the tuned one; on both sides. Where there is nothing to trade,
/// the goal's figure over the trials.
LinePlot pareto_plot(const TuneFile& file, const Tuned& tuned);

/// A panel for each parameter: goals and limited figures as it alone varies.
std::vector<LinePlot> sensitivity_plots(const TuneFile& file, const Tuned& tuned);

/// All of them as one SVG document.
std::string tune_svg(const TuneFile& file, const Tuned& tuned);

}  // namespace understory
