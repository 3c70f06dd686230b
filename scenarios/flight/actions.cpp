#include "scenarios/flight/actions.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>

#include "perception/io/text_table.hpp"

namespace understory {
namespace {

constexpr const char* header = "t_ns,left_elevon_rad,right_elevon_rad,thrust_n";

}  // namespace

std::string actions_text(const std::vector<Action>& actions) {
  std::string text = std::string(header) + "\n";
  for (const Action& action : actions)
    text += fmt::format("{},{},{},{}\n", action.t_ns, action.controls.left_elevon_rad,
                        action.controls.right_elevon_rad, action.controls.thrust_n);
  return text;
}

std::vector<Action> parse_actions(const std::string& text, const std::string& name) {
  const std::string expected = std::string("expected '") + header + "'";
  std::vector<Action> actions;
  constexpr std::array columns{Column{"t_ns|timestamp", "ns"}, Column{"left_elevon_rad|left_elevon", "rad"},
                               Column{"right_elevon_rad|right_elevon", "rad"},
                               Column{"thrust_n|thrust", "n"}};
  for (const TableLine& line : named_table(text, CellsParted::by_commas, name, columns).lines) {
    if (line.cells.size() != 4) fail_at_line(name, line.number, expected);
    const std::optional<std::int64_t> t_ns = nanoseconds_in(line.cells[0]);
    const auto left = number_in(line.cells[1]), right = number_in(line.cells[2]),
               thrust = number_in(line.cells[3]);
    if (!t_ns || !left || !right || !thrust) fail_at_line(name, line.number, expected);
    if (!actions.empty() && *t_ns <= actions.back().t_ns)
      fail_at_line(name, line.number, "each action must be later than the one before it");
    actions.push_back({*t_ns, {*left, *right, *thrust}});
  }
  if (actions.empty()) fail_at_line(name, 1, expected + " and at least one action");
  return actions;
}

Controls RecordedPilot::controls(std::int64_t t_ns, const State& /*state*/) {
  while (next_ < actions_.size() && actions_[next_].t_ns <= t_ns) ++next_;
  return next_ == 0 ? Controls{} : actions_[next_ - 1].controls;
}

}  // namespace understory
