#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scenarios/output/folder_mark.hpp"
#include "scenarios/output/program.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "scenarios/tuning/judge.hpp"
#include "scenarios/tuning/search.hpp"
#include "scenarios/tuning/tune_file.hpp"

namespace understory {

/// A configuration and its measured figures.
struct Trial {
  int number = 0;
  Point point;
  Figures figures;       ///< empty where it was refused
  std::string refused;   ///< why, one line
  bool dropped = false;  ///< after a glance (race.hpp), by which the figures are estimated
};

/// Measures the scenario with a point's values; refused, too, where these contradict each other.
Measured measure_at(const Point& point, const TuneFile& file, Judge& judge, const std::string& name,
                    Look look = Look::whole);

/// Each number under its name; as text null where it is not finite.
nlohmann::ordered_json numbers_of(const std::vector<std::string>& names, const std::vector<double>& values);

/// Trials in their order, each a line of a JSON Lines file on disk before the next begins. Evaluating a point
/// again gives what the file holds: a search that is repeated with the same arguments goes on where it was
/// stopped.
class TrialLog {
 public:
  using Measure = std::function<Trial(int number, const Point&)>;  ///< sets figures or refused

  /// Reads what `file` holds, if anything, and cuts off a last line that was not finished. Throws
  /// ScenarioError where a line before it is not whole or has other parameters or figures.
  TrialLog(std::filesystem::path file, std::vector<std::string> parameters, std::vector<std::string> figures,
           Measure measure);

  /// The next trial: out of the file where it is there, else measured; a point that was tried before is not
  /// measured again. Throws ScenarioError where the file has another point in its place, MachineError where
  /// the line cannot be written.
  Trial evaluate(const Point& point);

  const std::vector<Trial>& evaluated() const { return evaluated_; }
  /// To be called when nothing more is evaluated. Throws ScenarioError where the file holds more.
  void finish() const;

 private:
  void append(const Trial& trial);

  std::filesystem::path file_;
  std::vector<std::string> parameters_, figures_;
  Measure measure_;
  std::vector<Trial> held_, evaluated_;  ///< by the file when it was opened, and since
  std::map<Point, std::size_t> places_;  ///< in evaluated_
};

/// Makes the folder, or, with `resume`, checks that it holds this very tuning, begun by this program. Throws
/// ScenarioError in one line if not, as prepare_campaign_folder does. `identity`: of what the trials are
/// judged with and on.
void prepare_tune_folder(FolderMark& mark, const std::filesystem::path& folder, const TuneFile& file,
                         bool resume, const Identity& identity = {});

/// One parameter alone varied over its range, everything else as the best has it; on training data.
struct Sensitivity {
  std::vector<double> values;  ///< ascending, the best's own among them
  std::vector<Figures> figures;
};

/// One configuration on training and validation data. `number` 0: the scenario as it is.
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

/// What a configuration flies: flights' counts, in the order of the seeds.
struct FlownTrial {
  std::string name;  ///< "as it is", "tuned", "front"
  Trial trial;
  std::vector<Counts> flights;  ///< empty where one could not be flown
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
  std::vector<FlownTrial> flown;      ///< over recordings, if asked for: the first is the scenario as it is
};

inline constexpr std::size_t maximum_front = 20;

/// How far a tuning is.
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

/// Searches on training data, then measures the results on validation data, then varies each parameter, then
/// flies the scenario as it is, the best, and the front's ends, where there is a judge of flights. What the
/// folder's logs hold is not measured again. Throws Stopped if `stop_asked`, ScenarioError if the logs
/// are another tuning's or every trial was refused.
Tuned tune(const TuneFile& file, Judge& training, Judge& validation, const TuneOptions& options,
           Judge* flights = nullptr);

/// Of flights with the same seeds: which reached the goal.
PairedOutcomes paired_goals(const std::vector<Counts>& before, const std::vector<Counts>& after);

}  // namespace understory
