#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/campaign/flight_row.hpp"
#include "scenarios/cli/arguments.hpp"
#include "scenarios/cli/commands.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/config/keys.hpp"
#include "scenarios/flight/flight_result.hpp"
#include "scenarios/report/table.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

struct KeysArguments {
  std::string scenario;
  bool json = false, markdown = false;
};

/// Fields of a result or a row, whose structs say what they mean: `owner` for its own, else what both
/// measure.
Key key_of_measure(const char* owner, const std::string& name) {
  const Key own = key_of_field(owner, name);
  return own.meaning.empty() ? key_of_field("FlightMeasures", name) : own;
}

std::vector<Key> row_keys() {
  std::vector<Key> columns;
  for (const std::string& name : table_from_csv(to_csv(std::vector<FlightRow>{}), "columns").head)
    columns.push_back(key_of_measure("FlightRow", name));
  return columns;
}

std::vector<Key> result_keys() {
  std::vector<Key> keys;
  const FlightResult result;
  const auto add = [&](std::string_view name, const auto&) {
    keys.push_back(key_of_measure("FlightResult", std::string(name)));
  };
  visit_fields(add, result);
  for (const char* list : {"points_on_obstacles", "timings"}) add(list, 0);
  return keys;
}

Table table_of(const std::vector<Key>& keys, bool are_columns) {
  Table table{are_columns ? std::vector<std::string>{"Column", "Unit", "Meaning"}
                          : std::vector<std::string>{"Key", "Default", "Unit", "Range", "Meaning", "Source"}};
  for (const Key& key : keys) {
    if (are_columns)
      table.rows.push_back({key.name, key.unit, key.meaning});
    else
      table.rows.push_back({key.name, key.value, key.unit, key.range, key.meaning, key.source});
  }
  return table;
}

/// docs/keys.md.
std::string page_of(const std::vector<Key>& keys) {
  return fmt::format(
      "# Keys and columns\n\n"
      "Made by `understory keys --markdown`, a test checks that it is current. `understory keys SCENARIO` "
      "shows the values of one scenario; [scenarios.md](scenarios.md) says how a scenario is written. "
      "Meanings "
      "and sources are the comments beside the fields; a value without a source was chosen or measured "
      "here.\n\n"
      "## Keys of a scenario\n\n{}\n"
      "## Columns of flights.csv\n\nA row per flight of a campaign; the keys of each line of flights.jsonl, "
      "too.\n\n{}\n"
      "## Keys of result.json\n\n{}\n"
      "## Columns of trajectory.csv\n\nA row each 5 ms: time, the true pose of the centre of mass in the "
      "world "
      "(quaternion from body to world), velocity, angular rate about the body's axes; `est_`: the same as "
      "the "
      "aircraft estimates it; commands; what the actuators did of them; distance from the wing to the "
      "nearest "
      "obstacle.\n\n```\n{}```\n",
      to_markdown(table_of(keys, false)), to_markdown(table_of(row_keys(), true)),
      to_markdown(table_of(result_keys(), true)), trajectory_columns);
}

std::string json_of(const std::vector<Key>& keys, const std::vector<Key>& defaults) {
  Json json = Json::array();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Key& key = keys[i];
    const auto value_of = [](const std::string& text) {
      const Json value = Json::parse(text, nullptr, false);
      return value.is_discarded() ? Json(text) : value;
    };
    json.push_back({{"key", key.name},
                    {"value", value_of(key.value)},
                    {"default", value_of(defaults[i].value)},
                    {"unit", key.unit},
                    {"range", key.range},
                    {"meaning", key.meaning},
                    {"source", key.source}});
  }
  return json_text(json, 1) + "\n";
}

std::string lines_of(const std::vector<Key>& keys, const std::vector<Key>& defaults) {
  std::string text;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Key& key = keys[i];
    text += fmt::format("{}: {}{}{}  ({})  {}{}\n", key.name, key.value, key.unit.empty() ? "" : " ",
                        key.unit, key.range, key.meaning,
                        key.value == defaults[i].value ? "" : fmt::format("; default {}", defaults[i].value));
  }
  return text;
}

int run_keys(const KeysArguments& arguments) {
  const std::vector<Key> defaults = keys_of(scenario_from_text("{}", "defaults"));
  const std::vector<Key> keys =
      arguments.scenario.empty() ? defaults : keys_of(load_scenario(scenario_file(arguments.scenario)));
  fmt::print("{}", arguments.json       ? json_of(keys, defaults)
                   : arguments.markdown ? page_of(keys)
                                        : lines_of(keys, defaults));
  return exit_goal;
}

}  // namespace

void add_keys_command(CommandLine& line) {
  const auto arguments = std::make_shared<KeysArguments>();
  Command& command = line.add({"keys", "print each key of a scenario: value, unit, range, meaning, source",
                               "understory keys forest | grep planner"});
  command.text("scenario", "SCENARIO", arguments->scenario, "whose values to print (default: the defaults)");
  const auto json = command.flag("--json", arguments->json, "as JSON");
  command.flag("--markdown", arguments->markdown, "as docs/keys.md, with the columns of results")
      .excludes(json);
  command.runs([arguments] { return run_keys(*arguments); });
}

}  // namespace understory
