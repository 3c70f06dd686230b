#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scenarios/tuning/search.hpp"
#include "scenarios/tuning/tune_file.hpp"

namespace understory {

/// A configuration and what it was measured to be.
struct Trial {
  int number = 0;
  Point point;
  Figures figures;      ///< empty where it was refused
  std::string refused;  ///< why, one line
};

/// Trials in their order, each a line of a JSON Lines file on disk before the next begins. Evaluating again
/// what the file holds gives what it holds: a search that is repeated with the same arguments goes on where
/// it was stopped.
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

 private:
  void append(const Trial& trial);

  std::filesystem::path file_;
  std::vector<std::string> parameters_, figures_;
  Measure measure_;
  std::vector<Trial> held_, evaluated_;  ///< by the file when it was opened, and since
  std::map<Point, std::size_t> places_;  ///< in evaluated_
};

/// Makes the folder, or, with `resume`, makes sure that it holds this very tuning, begun by this program.
/// Throws ScenarioError in one line where not, as prepare_campaign_folder does.
void prepare_tune_folder(const std::filesystem::path& folder, const TuneFile& file,
                         const std::string& renderer, bool resume);

}  // namespace understory
