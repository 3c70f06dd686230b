#include "scenarios/explain/explain_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scenarios/config/config_tree.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string to_json(const ExplainedFlight& explained) {
  const auto& [why, conclusion, evidence] = explained.told;
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
            {"last_chance_s", why.last_chance_s ? Json(*why.last_chance_s) : Json()},
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

ToldExplanation explanation_from_json(const std::string& text, const std::string& name) try {
  const Json json = parse_json(text);
  ToldExplanation told;
  told.conclusion = {json.at("cause"), json.at("sentence"), json.at("disagreement")};
  told.explanation.cause = json.at("part");
  told.explanation.parts = json.at("parts").get<std::vector<std::string>>();
  told.explanation.decisive_s = json.at("decisive_s").get<std::vector<double>>();
  for (const Json& one : json.at("flights"))
    told.explanation.flights.push_back({one.at("parts").get<std::vector<std::string>>(),
                                        one.at("before_end_s"), one.at("redraw"), one.at("survived")});
  if (const Json& moment = json.at("last_chance_s"); !moment.is_null())
    told.explanation.last_chance_s = moment;
  for (const Json& one : json.at("evidence"))
    told.evidence.push_back({one.at("cause"), one.at("part"), one.at("is_there"), one.at("sentence")});
  summarise(told.explanation);
  return told;
} catch (const Json::exception&) {
  throw ScenarioError(fmt::format("{}: not an explanation of this version; explain the run again", name));
}

std::vector<SheetSection> explanation_chapter(const ToldExplanation& told) {
  const Explanation& why = told.explanation;
  LinePlot plot{.title = "Chance to survive", .x_label = "time, s (0 is the end)", .y_label = "survived, %"};
  double beside_s = 0;  // bars at one place would hide each other
  const auto add = [&](const std::string& part, const std::string& name, Mark mark) {
    Series series{.name = name, .mark = mark};
    if (mark == Mark::dots) beside_s += 0.03;
    for (const Chance& chance : why.chances) {
      if (chance.part != part) continue;
      const Interval interval =
          wilson_interval(static_cast<int>(chance.flown.with), static_cast<int>(chance.flown.of));
      series.x.push_back((mark == Mark::dots ? beside_s - 0.03 : 0) - chance.before_end_s);
      series.y.push_back(100 * (mark == Mark::line ? chance.fitted : chance.flown.value()));
      if (mark == Mark::line) continue;
      series.low.push_back(100 * interval.minimum);
      series.high.push_back(100 * interval.maximum);
    }
    plot.series.push_back(std::move(series));
  };
  add(std::string(the_control), "control, fitted", Mark::line);
  add(std::string(the_control), "control", Mark::dots);
  std::size_t shown = 0;
  for (const Effect& effect : why.effects)
    if (effect.part == why.cause || effect.part == all_ideal || shown < 3) {
      add(effect.part, "ideal " + effect.part, Mark::dots);
      shown += effect.part != all_ideal;
    }
  if (why.last_chance_s) plot.references.push_back({-*why.last_chance_s, "last chance", true});
  std::vector<SheetSection> sections{{.title = "Why it was lost: " + told.conclusion.cause,
                                      .text = told.conclusion.sentence,
                                      .plots = {plot},
                                      .table = effects_table(why)}};
  if (!told.conclusion.disagreement.empty()) sections.front().text += " " + told.conclusion.disagreement;
  Table log{{"cause", "part", "the log shows it", "what the log says"}};
  for (const Evidence& one : told.evidence)
    log.add(one.cause, one.part, one.is_there ? "yes" : "no", one.sentence);
  sections.push_back({.title = "What the log shows of each cause", .table = log});
  return sections;
}

Table effects_table(const Explanation& explanation) {
  Table table{{"ideal part"}};
  for (const double moment_s : explanation.decisive_s)
    table.head.push_back(fmt::format("with and without, {:.2f} s", moment_s));
  table.head.emplace_back("effect, % (95 %)");
  for (const Effect& effect : explanation.effects) {
    std::vector<std::string>& cells = table.rows.emplace_back();
    cells.push_back(effect.part);
    for (const double moment_s : explanation.decisive_s) {
      const PairedOutcomes at = pairs_at(explanation, effect.part, moment_s);
      cells.push_back(fmt::format("{} and {} of {}", at.second(), at.first(), at.pairs()));
    }
    const Interval interval = effect.interval();
    cells.push_back(fmt::format("{:+.0f} ({:+.0f} to {:+.0f})", 100 * effect.difference(),
                                100 * interval.minimum, 100 * interval.maximum));
  }
  return table;
}

Table chances_table(const Explanation& explanation) {
  Table table{{"control from, s before the end", "survived", "of", "fitted chance, %"}};
  for (const Chance& chance : explanation.chances)
    if (chance.part == the_control)
      table.add(fmt::format("{:.2f}", chance.before_end_s), chance.flown.with, chance.flown.of,
                fmt::format("{:.0f}", 100 * chance.fitted));
  return table;
}

}  // namespace understory
