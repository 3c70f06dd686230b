#include "scenarios/campaign/flight_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "perception/io/text_table.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/flight/flight_result.hpp"
#include "scenarios/report/table.hpp"
#include "scenarios/scenario/scenario.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 5> status_names{"flown", "crashed", "hung", "killed", "refused"};

/// Calls visit(name, field) for the columns in their order: first what every flight has, then, from `outcome`
/// on, what only a flown one has.
template <typename Row, typename Visit>
void visit_columns(Row& row, Visit&& visit) {
  visit("id", row.id, "name of the flight: \"<condition>-<seed>\"");
  visit("condition", row.condition, "name of the campaign's condition: a scenario with overrides");
  visit("seed", row.seed, "the scenario's seed, for course, wind and, without sensors.seed, sensors");
  visit("status", row.status,
        "flown: with an outcome; crashed: the program failed; hung: took longer than the campaign allows; "
        "killed: from outside; refused: bad input");
  visit("reason", row.reason, "why the flight has no outcome, in one line; empty if status is flown");
  visit("outcome", row.outcome,
        "how the flight ended: goal, collision, ground (touched), out_of_bounds (sides "
        "or altitude limits) or time (limit reached); empty unless status is flown");
  visit("renderer", row.renderer, "name of the OpenGL renderer that drew the images; empty without images");
  visit("cruise_speed_mps", row.cruise_speed_mps, "commanded cruise airspeed");
  visit("square_metres_per_tree", row.square_metres_per_tree, "mean ground area per tree of the forest");
  visit("goal_m", row.goal_m, "x coordinate of the goal plane");
  using Measures = std::conditional_t<std::is_const_v<Row>, const FlightMeasures, FlightMeasures>;
  visit_fields(visit, static_cast<Measures&>(row));
}

template <typename Value>
bool says_something(const Value& value) {
  if constexpr (std::floating_point<Value>) return std::isfinite(value);
  if constexpr (std::same_as<Value, std::int64_t>) return value >= 0;  // a count
  return true;
}

/// Calls put(name, value) for each column, put(name, nullptr) where the row says nothing there.
template <typename Put>
void put_columns(const FlightRow& row, Put&& put) {
  bool is_measured = false;
  visit_columns(row, [&](std::string_view name, const auto& value, std::string_view) {
    is_measured = is_measured || name == "outcome";
    if ((is_measured && !row.flown()) || !says_something(value))
      put(name, nullptr);
    else if constexpr (std::is_same_v<decltype(value), const RunStatus&>)
      put(name, std::string(status_names[static_cast<std::size_t>(value)]));
    else
      put(name, value);
  });
}

Json json_of(const FlightRow& row) {
  Json json;
  put_columns(row, [&](std::string_view name, const auto& value) { json[std::string(name)] = value; });
  for (const auto& [key, value] : row.more) json[key] = value;
  return json;
}

std::string cell_of(std::nullptr_t) { return ""; }
std::string cell_of(const std::string& text) { return text; }
std::string cell_of(double number) { return fmt::format("{:.6g}", number); }
std::string cell_of(std::integral auto count) { return fmt::format("{}", count); }

/// False where the text is no such value.
template <typename Value>
bool take(const std::string& text, Value& value) {
  if constexpr (std::is_same_v<Value, std::string>) {
    value = text;
    return true;
  } else if constexpr (std::is_same_v<Value, RunStatus>) {
    const auto found = std::ranges::find(status_names, text);
    value = static_cast<RunStatus>(found - status_names.begin());
    return found != status_names.end();
  } else {
    const auto number = number_in<Value>(text);
    if (number) value = *number;
    if constexpr (std::same_as<Value, std::int64_t>) return number && *number >= 0;  // a count
    return number.has_value();
  }
}

/// A row's text, column by column, as `text_of(name)` has it; false where a value is none.
template <typename TextOf>
bool take_row(FlightRow& row, TextOf&& text_of) {
  row.minimum_clearance_m = std::numeric_limits<double>::infinity();
  bool is_whole = true, is_measured = false;
  visit_columns(row, [&](std::string_view name, auto& value, std::string_view) {
    is_measured = is_measured || name == "outcome";
    const std::string text = text_of(name);
    constexpr std::array<std::string_view, 16> optional{"reason",
                                                        "renderer",
                                                        "minimum_clearance_m",
                                                        "minimum_points_on_an_obstacle",
                                                        "digest",
                                                        "left_through",
                                                        "touched",
                                                        "touched_by",
                                                        "in_view_m",
                                                        "in_view_s",
                                                        "detected_m",
                                                        "detected_s",
                                                        "points_of_touched",
                                                        "points_off_m",
                                                        "last_plan",
                                                        "last_plan_clearance_m"};
    const bool may_be_empty =
        (is_measured && !row.flown()) || std::ranges::find(optional, name) != optional.end();
    is_whole = (text.empty() ? may_be_empty : take(text, value)) && is_whole;
  });
  return is_whole && row.flown() == outcome_named(row.outcome).has_value();
}

Table empty_table() {
  Table table;
  for (const Key& column : flight_row_columns()) table.head.push_back(column.name);
  return table;
}

}  // namespace

std::vector<Key> flight_row_columns() {
  std::vector<Key> columns;
  const FlightRow any;
  visit_columns(any, [&](std::string_view name, const auto&, std::string_view meaning) {
    columns.push_back(key_of(name, meaning));
  });
  return columns;
}

FlightRow flown_row(const std::string& condition, const Scenario& scenario, const FlightResult& result) {
  FlightRow row;
  row.id = fmt::format("{}-{}", condition, result.seed);
  row.condition = condition;
  row.cruise_speed_mps = scenario.autopilot.flight_model.cruise_speed_mps;
  row.square_metres_per_tree = scenario.forest.square_metres_per_tree;
  row.goal_m = scenario.goal_x_m();
  row.seed = result.seed;
  row.status = RunStatus::flown;
  row.outcome = word_for(result.outcome);
  row.renderer = result.renderer;
  static_cast<FlightMeasures&>(row) = result;
  return row;
}

std::string to_json_line(const FlightRow& row) { return json_text(json_of(row)); }

std::string to_json(const FlightFile& file) {
  const Json json{{"format", results_format},
                  {"row", json_of(file.row)},
                  {"wall_s", file.cost.wall_s},
                  {"peak_memory_mb", file.cost.peak_memory_mb}};
  return json_text(json, 1) + "\n";
}

std::optional<FlightFile> flight_file_from_json(const std::string& text) try {
  const Json json = parse_json(text);
  if (!json.is_object() || json.value("format", 0) != results_format || !json.contains("row")) return {};
  FlightFile file;
  const auto text_of = [&](std::string_view name) {
    const Json value = json["row"].value(std::string(name), Json(nullptr));
    return value.is_null() ? std::string() : value.is_string() ? value.get<std::string>() : json_text(value);
  };
  if (!take_row(file.row, text_of)) return {};
  file.cost = {json.value("wall_s", 0.0), json.value("peak_memory_mb", 0.0)};
  return file;
} catch (const Json::exception&) {  // a value of another type
  return {};
}

std::string to_csv(const std::vector<FlightRow>& rows) {
  Table table = empty_table();
  for (const FlightRow& row : rows) {
    std::vector<std::string>& cells = table.rows.emplace_back();
    put_columns(row, [&](std::string_view, const auto& value) { cells.push_back(cell_of(value)); });
    for (const auto& [key, value] : row.more) {
      if (table.rows.size() == 1) table.head.push_back(key);
      cells.push_back(value);
    }
  }
  return to_csv(table);
}

std::vector<FlightRow> rows_from_csv(const std::string& text, const std::string& name) {
  const Table expected = empty_table(), table = table_from_csv(text, name);
  if (table.head.size() < expected.head.size() ||
      !std::equal(expected.head.begin(), expected.head.end(), table.head.begin()))
    throw ScenarioError(fmt::format("{}:1: must name the columns of results format {}: {}", name,
                                    results_format, fmt::join(expected.head, ",")));
  std::vector<FlightRow> rows;
  std::set<std::string> seen;
  int line = 2;
  for (const std::vector<std::string>& cells : table.rows) {
    auto cell = cells.begin();
    if (!take_row(rows.emplace_back(), [&](std::string_view) { return *cell++; }))
      refuse_input(place_in(name, line), cells.front(), "not a whole row as understory writes it");
    const FlightRow& row = rows.back();
    if (!seen.insert(fmt::format("{} {}", row.condition, row.seed)).second)
      refuse_input(place_in(name, line), cells.front(), "this condition and seed are there twice");
    for (const std::string& words : cells) line += static_cast<int>(std::ranges::count(words, '\n'));
    ++line;
  }
  return rows;
}

}  // namespace understory
