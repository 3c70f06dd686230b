#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/explain/explanation.hpp"
#include "scenarios/flight/flight_log.hpp"

namespace understory {

/// What the log shows of a cause, in words that a person understands. docs/explain.md has the table.
struct Evidence {
  std::string cause;      ///< "not detected", "forgotten", ...
  std::string part;       ///< whose effect it needs
  bool is_there = false;  ///< in this flight's log
  std::string sentence;   ///< what the log shows of it, with its numbers
};

/// Of every cause that a part has, whether it is there or not; a fault of a sensor only where there is one.
/// `last_chance_s` before the end (Explanation::decisive_s): a search that fails later decides nothing.
std::vector<Evidence> evidence_in(const FlightLog& log, double last_chance_s);

/// The explanation in words.
struct Conclusion {
  std::string cause;     ///< "not detected"; for joint, infeasible and chance that word
  std::string sentence;  ///< one, for people who read no further
  /// Where the log does not show what the effect says, or shows something else: a sentence; else empty.
  std::string disagreement = {};
};
Conclusion conclusion_of(const Explanation& explanation, const std::vector<Evidence>& evidence);

/// With all that it rests on, as explain.json of a run has it.
struct ToldExplanation {
  Explanation explanation;
  Conclusion conclusion;
  std::vector<Evidence> evidence;
};

}  // namespace understory
