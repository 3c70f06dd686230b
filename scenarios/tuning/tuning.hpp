#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/statistics/proportions.hpp"
#include "scenarios/tuning/judge.hpp"
#include "scenarios/tuning/tune_file.hpp"
#include "scenarios/tuning/tune_folder.hpp"

namespace understory {

/// One parameter alone varied over its range, everything else as the best has it; on training data.
struct Sensitivity {
  std::vector<double> values;  ///< ascending, the best's own among them
  std::vector<Figures> figures;
};

/// One configuration on both sides. `number` 0: the scenario as it is.
struct JudgedTrial {
  Trial training;
  Trial validation;
};

/// One figure on validation data: the tuned configuration less the scenario as it is. Units (recordings,
/// flights) are drawn in pairs, with replacement, and their counts put together (BCa bootstrap). Success of
/// flights is the exception: Newcombe's interval for paired shares.
struct FigureChange {
  double difference = 0;
  Interval interval;  ///< 95 %; -infinity .. infinity where the data cannot say
};

struct Tuned {
  std::vector<Trial> trials;  ///< 0: the scenario as it is; then the search's
  bool keeps_limits = true;   ///< the best, on training data; otherwise it misses them by the smallest amount
  JudgedTrial scenario, best;            ///< chosen by training; `validation` is what counts
  std::vector<JudgedTrial> front;        ///< of training, thinned to at most `maximum_front`
  std::vector<Sensitivity> sensitivity;  ///< of each parameter
  /// Counts on validation data, for statements about the difference; empty where one was refused.
  std::vector<Counts> scenario_units, best_units;
  std::vector<FigureChange> changes;  ///< of the figures, in their order; empty likewise
};

inline constexpr std::size_t maximum_front = 20;

/// How far it is.
struct TuneProgress {
  std::string part;  ///< "trial", "validation", "sensitivity"
  std::size_t done = 0, of = 0;
  std::size_t measured = 0;  ///< since this run began, in all
  std::size_t left = 0;      ///< to be measured, in all, as far as known
  double best = 0;           ///< the first goal's figure
};

struct TuneOptions {
  std::filesystem::path folder;  ///< that is there: trials.jsonl, validation.jsonl, sensitivity.jsonl
  std::function<bool()> stop_asked = [] { return false; };
  std::function<void(const TuneProgress&)> on_progress = [](const TuneProgress&) {};
};

/// Searches on training data, then measures what came out on validation data, then varies each parameter.
/// What the folder's logs hold is not measured again. Throws Stopped where `stop_asked`, ScenarioError where
/// the logs are another tuning's or every trial was refused.
Tuned tune(const TuneFile& file, Judge& training, Judge& validation, const TuneOptions& options);

/// Flights only: which seeds reached the goal; first: the scenario, second: the tuned one.
PairedOutcomes paired_goals(const Tuned& tuned);

}  // namespace understory
