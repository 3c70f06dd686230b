#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scenarios/tuning/objective.hpp"
#include "scenarios/tuning/space.hpp"

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
  std::size_t held() const { return held_.size(); }  ///< by the file, when it was opened

 private:
  void append(const Trial& trial);

  std::filesystem::path file_;
  std::vector<std::string> parameters_, figures_;
  Measure measure_;
  std::vector<Trial> held_, evaluated_;
  std::map<Point, std::size_t> places_;  ///< in evaluated_
};

/// The trials with a header, six digits a figure.
std::string to_csv(const std::vector<Trial>& trials, const std::vector<std::string>& parameters,
                   const std::vector<std::string>& figures);

}  // namespace understory
