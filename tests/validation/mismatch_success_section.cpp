#include <fmt/format.h>

#include <cmath>

#include "tests/validation/mismatch_sections.hpp"
#include "tests/validation/page.hpp"

namespace understory {
namespace {

std::string endings_text(const FlightTally& tally) {
  std::string text;
  for (const Ending ending : {Ending::collision, Ending::ground, Ending::out_of_bounds, Ending::time}) {
    if (const int count = tally.count(ending); count > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count,
                          ending == Ending::out_of_bounds ? "out of bounds" : word_for(ending));
  }
  return text;
}

std::string success_table(const std::vector<FlownCondition>& all) {
  std::vector<std::vector<std::string>> rows;
  for (const FlownCondition& flown : all) {
    const FlightTally& tally = flown.tally;
    const Interval success = tally.success();
    rows.push_back({flown.condition.name(),
                    flies_level(flown)
                        ? fmt::format("{:.1f} to {:.1f}", flown.level_mps.minimum, flown.level_mps.maximum)
                        : "nowhere",
                    fmt::format("{:.1f}", tally.mean_speed_mps()),
                    fmt::format("{} of {}", tally.goals(), tally.flights()),
                    fmt::format("{:.0f} to {:.0f} %", 100 * success.minimum, 100 * success.maximum),
                    endings_text(tally)});
  }
  return markdown_table(
      {"mismatch", "flies level at (m/s)", "flew at (m/s)", "goals", "95 % interval", "else"}, rows);
}

}  // namespace

Section mismatch_success_section(const std::vector<FlownCondition>& all) {
  const FlightTally& model = all.front().tally;
  const double minimum_goals = std::ceil(model.success().minimum * model.flights());
  Section section;
  section.title = "Success";
  section.markdown =
      success_table(all) +
      fmt::format(
          "\nThe interval is Wilson's: {} flights cannot show a loss of a few percent. Level flight is what "
          "the flat plates and the motor of that aircraft allow at angles of attack up to the follower's "
          "cap; the speed flown is the mean over ground, the catapult's included. Asked of every aircraft "
          "that can fly level at all: no fewer goals than the lower end of the model's own interval.\n\nThe "
          "motor decides. Level flight at 12.3 m/s takes 95 % of its thrust (docs/flight_model.md), so that "
          "what makes the aircraft heavier or blunter first makes it slower, and one with no level flight "
          "left sinks out of the altitude band, wherever the trees stand. What could make the control loop "
          "swing, less damping or twice the delay (another 20 ms), costs no goal and hardly any speed.\n",
          model.flights());
  LinePlot goals = curves(all, "Flights that reach the goal", "goals (%)",
                          [](const FlightTally& tally) { return 100.0 * tally.goals() / tally.flights(); });
  goals.y_range = AxisRange{-5, 105};
  goals.references = {{100 * model.success().minimum, "least of the model's own 95 % interval"}};
  const LinePlot speeds = curves(all, "Speed", "mean speed (m/s)",
                                 [](const FlightTally& tally) { return tally.mean_speed_mps(); });
  section.figures = {{"success", "Success and speed over mismatch", to_svg({goals, speeds}, 2)}};
  section.checks = {at_least("goals, no mismatch", model.goals(), 9, "")};
  for (const FlownCondition& flown : all)
    if (!flown.condition.what.empty() && flies_level(flown))
      section.checks.push_back(
          at_least("goals, " + flown.condition.name(), flown.tally.goals(), minimum_goals, ""));
  return section;
}

}  // namespace understory
