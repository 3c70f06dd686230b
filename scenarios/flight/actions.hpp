#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "planning/pilot.hpp"

/// The controls of a flight as a table, so that any flight can be flown again bit for bit.
namespace understory {

/// Controls in force from a moment on.
struct Action {
  std::int64_t t_ns = 0;
  Controls controls;
};

/// The table: 't_ns,left_elevon_rad,right_elevon_rad,thrust_n', a line for each action, every number with as
/// many digits as it has.
std::string actions_text(const std::vector<Action>& actions);

/// Reads it back. `name` stands for the file in messages. Throws InputError "name:line: expected ..." if a
/// line is not an action, or is not later than the one before it.
std::vector<Action> parse_actions(const std::string& text, const std::string& name);

/// Flies a table: the newest action that is not later. Before the first, surfaces are neutral.
class RecordedPilot : public Pilot {
 public:
  explicit RecordedPilot(std::vector<Action> actions) : actions_(std::move(actions)) {}
  Controls controls(std::int64_t t_ns, const State& state) override;

 private:
  std::vector<Action> actions_;
  std::size_t next_ = 0;
};

}  // namespace understory
