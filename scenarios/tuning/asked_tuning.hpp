#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/tuning/judge.hpp"
#include "scenarios/tuning/tune_file.hpp"

namespace understory {

/// A tuning that another program drives, with the search of the file, the judge of the file, or both: each
/// question is a line of JSON, and so is its answer (docs/tuning.md has the list).
class AskedTuning {
 public:
  /// Gives the judge of training or validation data; called when it is needed first.
  using JudgeOf = std::function<Judge&(bool validation)>;

  AskedTuning(const TuneFile& file, JudgeOf judge_of) : file_(file), judge_of_(std::move(judge_of)) {}

  /// Parameters with their ranges, figures, goals: what the other program must know before it asks.
  std::string greeting() const;
  /// A question that cannot be answered gets {"error": "..."}. Throws Stopped and MachineError as a judge
  /// does.
  std::string answer(const std::string& question);

 private:
  const TuneFile& file_;
  JudgeOf judge_of_;
  std::optional<Point> asked_;  ///< the trial that is to be told
  std::vector<Point> points_;   ///< told, in their order
  std::vector<Figures> figures_;
  int measured_ = 0;
};

}  // namespace understory
