#include "scenarios/explain/explain_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scenarios/config/config_tree.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string to_json(const ExplainedFlight& explained, const std::vector<Evidence>& evidence,
                    const Conclusion& conclusion) {
  const Explanation& why = explained.explanation;
  Json json{{"scenario", explained.log.scenario.name},
            {"seed", explained.log.scenario.seed},
            {"digest", explained.log.result.digest},
            {"outcome", word_for(explained.log.result.outcome)},
            {"end_s", explained.log.result.simulated_s},
            {"cause", conclusion.cause},
            {"part", why.cause},
            {"parts", why.parts},
            {"sentence", conclusion.sentence},
            {"disagreement", conclusion.disagreement},
            {"no_return_s", why.no_return_s ? Json(*why.no_return_s) : Json()},
            {"decisive_s", why.decisive_s}};
  for (const Effect& effect : why.effects)
    json["effects"].push_back({{"part", effect.part},
                               {"difference", effect.difference()},
                               {"interval", {effect.interval().minimum, effect.interval().maximum}},
                               {"pairs", effect.pairs.pairs()}});
  for (const Chance& chance : why.chances)
    json["chances"].push_back({{"part", chance.part},
                               {"before_end_s", chance.before_end_s},
                               {"survived", chance.flown.with},
                               {"flown", chance.flown.of},
                               {"fitted", chance.fitted}});
  for (const Evidence& one : evidence)
    json["evidence"].push_back(
        {{"cause", one.cause}, {"part", one.part}, {"is_there", one.is_there}, {"sentence", one.sentence}});
  for (const Redraw& one : why.flights)
    json["flights"].push_back({{"parts", one.parts},
                               {"before_end_s", one.before_end_s},
                               {"redraw", one.seed},
                               {"survived", one.survived}});
  return json_text(json, 1) + "\n";
}

Table effects_table(const Explanation& explanation) {
  Table table{{"ideal part", "more survive, %", "95 %", "pairs"}};
  for (const Effect& effect : explanation.effects)
    table.add(
        effect.part, fmt::format("{:+.0f}", 100 * effect.difference()),
        fmt::format("{:+.0f} to {:+.0f}", 100 * effect.interval().minimum, 100 * effect.interval().maximum),
        effect.pairs.pairs());
  return table;
}

Table chances_table(const Explanation& explanation) {
  Table table{{"before the end, s", "survived", "of", "fitted chance, %"}};
  for (const Chance& chance : explanation.chances)
    if (chance.part == the_control)
      table.add(fmt::format("{:.2f}", chance.before_end_s), chance.flown.with, chance.flown.of,
                fmt::format("{:.0f}", 100 * chance.fitted));
  return table;
}

}  // namespace understory
