#include "scenarios/campaign/flight_row_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "scenarios/config/config_tree.hpp"

namespace understory {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<std::string_view, RunStatus>, 5> status_names{
    {{"flown", RunStatus::flown},
     {"crashed", RunStatus::crashed},
     {"hung", RunStatus::hung},
     {"killed", RunStatus::killed},
     {"refused", RunStatus::refused}}};

/// The columns, in their order: `is` for what a flight is, `measured` for what only a flown one has.
template <typename Row, typename Is, typename Measured>
void visit_columns(Row& row, Is&& is, Measured&& measured) {
  is("id", row.id);
  is("condition", row.condition);
  is("seed", row.seed);
  is("status", row.status);
  is("reason", row.reason);
  measured("outcome", row.outcome);
  measured("cruise_speed_mps", row.cruise_speed_mps);
  measured("square_metres_per_tree", row.square_metres_per_tree);
  measured("goal_m", row.goal_m);
  measured("distance_m", row.distance_m);
  measured("progress_m", row.progress_m);
  measured("mean_speed_mps", row.mean_speed_mps);
  measured("min_clearance_m", row.min_clearance_m);
  measured("position_error_mean_m", row.position_error_mean_m);
  measured("position_error_max_m", row.position_error_max_m);
  measured("detections", row.detections);
  measured("remembered_points", row.remembered_points);
  measured("minimum_points_on_a_bar", row.minimum_points_on_a_bar);
  visit_fields(measured, row.planner);
  measured("simulated_s", row.simulated_s);
  measured("digest", row.digest);
}

std::string one_cell(std::string text) {  // commas and quotes would want quoting; a reason does without
  std::ranges::replace(text, ',', ';');
  std::ranges::replace(text, '"', '\'');
  std::ranges::replace(text, '\n', ' ');
  return text;
}

template <typename Value>
Json json_value(const Value& value) {
  if constexpr (std::is_same_v<Value, RunStatus>)
    return std::ranges::find(status_names, value, &std::pair<std::string_view, RunStatus>::second)->first;
  else if constexpr (std::floating_point<Value>)
    return std::isfinite(value) ? Json(value) : Json(nullptr);  // JSON has no infinity
  else
    return value;
}

Json json_of(const FlightRow& row) {
  Json json;
  const auto put = [&](std::string_view name, const auto& value) {
    json[std::string(name)] = json_value(value);
  };
  visit_columns(row, put, [&](std::string_view name, const auto& value) {
    const bool counted = name != "minimum_points_on_a_bar" || row.minimum_points_on_a_bar >= 0;
    if (row.flown() && counted)
      put(name, value);
    else
      json[std::string(name)] = nullptr;
  });
  return json;
}

/// False where the text is no such value. Empty says nothing and leaves the value alone.
template <typename Value>
bool take(const std::string& text, Value& value) {
  if constexpr (std::is_same_v<Value, std::string>) {
    value = text;
    return true;
  } else if constexpr (std::is_same_v<Value, RunStatus>) {
    const auto found = std::ranges::find(status_names, text, &std::pair<std::string_view, RunStatus>::first);
    if (found != status_names.end()) value = found->second;
    return found != status_names.end();
  } else {
    if (text.empty()) return true;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
  }
}

/// A row's text, column by column, as `text_of(name)` has it; false where a value is none.
template <typename TextOf>
bool take_row(FlightRow& row, TextOf&& text_of) {
  row.min_clearance_m = std::numeric_limits<double>::infinity();
  bool is_whole = true;
  const auto read = [&](std::string_view name, auto& value) {
    is_whole = take(text_of(name), value) && is_whole;
  };
  visit_columns(row, read, read);
  return is_whole;
}

std::vector<std::string> column_names() {
  std::vector<std::string> names;
  const auto name_it = [&](std::string_view name, const auto&) { names.emplace_back(name); };
  const FlightRow any;
  visit_columns(any, name_it, name_it);
  return names;
}

std::string header() { return fmt::format("{}", fmt::join(column_names(), ",")); }

}  // namespace

std::string to_json_line(const FlightRow& row) { return json_of(row).dump(); }

std::string to_json(const FlightFile& file) {
  Json json;
  json["format"] = results_format;
  json["row"] = json_of(file.row);
  json["wall_s"] = file.cost.wall_s;
  json["peak_memory_mb"] = file.cost.peak_memory_mb;
  return json.dump(1) + "\n";
}

std::optional<FlightFile> flight_file_from_json(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("format", 0) != results_format || !json.contains("row")) return {};
  FlightFile file;
  const auto text_of = [&](std::string_view name) {
    const Json value = json["row"].value(std::string(name), Json(nullptr));
    return value.is_null() ? std::string() : value.is_string() ? value.get<std::string>() : value.dump();
  };
  if (!take_row(file.row, text_of)) return {};
  file.cost = {json.value("wall_s", 0.0), json.value("peak_memory_mb", 0.0)};
  return file;
}

std::string to_csv(const std::vector<FlightRow>& rows) {
  std::string csv = header() + "\n";
  for (const FlightRow& row : rows) {
    std::vector<std::string> cells;
    const Json json = json_of(row);
    for (const Json& value : json) {
      if (value.is_string())
        cells.push_back(one_cell(value.get<std::string>()));
      else if (value.is_number_float())
        cells.push_back(fmt::format("{:.6g}", value.get<double>()));
      else
        cells.push_back(value.is_null() ? std::string() : value.dump());
    }
    csv += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return csv;
}

std::vector<FlightRow> rows_from_csv(const std::string& text, const std::string& name) {
  std::istringstream stream(text);
  std::string line;
  std::getline(stream, line);
  if (line != header())
    throw ScenarioError(
        fmt::format("{}:1: expected the columns of results format {}: {}", name, results_format, header()));
  const std::vector<std::string> names = column_names();
  std::vector<FlightRow> rows;
  for (int number = 2; std::getline(stream, line); ++number) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
      if (c == ',')
        cells.emplace_back();
      else
        cells.back() += c;
    }
    FlightRow row;
    const auto text_of = [&](std::string_view column) {
      return cells[static_cast<std::size_t>(std::ranges::find(names, column) - names.begin())];
    };
    if (cells.size() != names.size() || !take_row(row, text_of))
      throw ScenarioError(
          fmt::format("{}:{}: expected a whole row of {} values", name, number, names.size()));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace understory
