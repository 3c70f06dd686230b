#include "scenarios/evaluation/flight_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <vector>

#include "scenarios/file_output.hpp"
#include "scenarios/statistics/wilson.hpp"

namespace understory {
namespace {

/// The columns and where result.json has them; `configuration` follows as the last.
struct Column {
  std::string_view name;
  const char* pointer;  ///< JSON pointer into result.json
};
constexpr std::array columns{
    Column{"seed", "/seed"},
    Column{"outcome", "/outcome"},
    Column{"distance_m", "/distance_m"},
    Column{"progress_m", "/progress_m"},
    Column{"mean_speed_mps", "/mean_speed_mps"},
    Column{"min_clearance_m", "/min_clearance_m"},
    Column{"position_error_mean_m", "/estimation/position_error_mean_m"},
    Column{"position_error_max_m", "/estimation/position_error_max_m"},
    Column{"detections", "/detections"},
    Column{"remembered_points", "/remembered_points"},
    Column{"replans", "/replans/count"},
    Column{"straight", "/replans/straight"},
    Column{"solved", "/replans/solved"},
    Column{"kept", "/replans/kept"},
    Column{"kept_ompl", "/replans/kept_ompl"},
    Column{"fallback", "/replans/fallback"},
    Column{"obstacle_ahead", "/replans/obstacle_ahead"},
    Column{"obstacle_ahead_ompl", "/replans/obstacle_ahead_ompl"},
    Column{"searches", "/replans/searches"},
    Column{"found", "/replans/searches_found"},
    Column{"least_points_on_a_bar", "/points_on_obstacles"},
    Column{"simulated_s", "/simulated_s"},
    Column{"wall_s", "/wall_s"},
    Column{"digest", "/digest"},
};
constexpr std::size_t column_count = columns.size() + 1;

constexpr std::size_t column(std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(columns, name, &Column::name) - columns.begin());
}

std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream stream(row);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

/// Empty where there is nothing to say; of a list of counts (points on each bar of a short course) the least.
std::string text_of(const nlohmann::json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_object()) {
    return text_of(*std::min_element(value.begin(), value.end()));
  }
  return value.is_number_integer() ? value.dump() : fmt::format("{:.4g}", value.get<double>());
}

}  // namespace

void FlightTable::add_row(const std::string& text) {
  const std::vector<std::string> cells = cells_of(text);
  if (cells.size() != column_count || cells.back() != configuration_) return;
  rows_[std::stoull(cells[column("seed")])] = {
      text, cells[column("outcome")], std::stod(cells[column("mean_speed_mps")]),
      std::stoll(cells[column("obstacle_ahead")]), std::stoll(cells[column("obstacle_ahead_ompl")])};
}

void FlightTable::read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) add_row(line);
}

void FlightTable::add_result(const std::filesystem::path& result_json) {
  std::ifstream stream(result_json);
  const nlohmann::json r = nlohmann::json::parse(stream, nullptr, false);
  if (r.is_discarded())
    throw MachineError(fmt::format("{}: a flight left no whole result", result_json.string()));
  std::string row;
  for (const Column& column : columns) {
    const nlohmann::json::json_pointer pointer(column.pointer);
    row += (r.contains(pointer) ? text_of(r[pointer]) : "") + ",";
  }
  add_row(row + configuration_);
}

std::string FlightTable::to_csv() const {
  std::string text;
  for (const Column& column : columns) text += fmt::format("{},", column.name);
  text += "configuration\n";
  for (const auto& [seed, row] : rows_) text += row.text + "\n";
  return text;
}

std::string FlightTable::summary(std::uint64_t first, std::uint64_t last) const {
  int flights = 0;
  double speed_sum = 0;
  std::int64_t blocked = 0, blocked_ompl = 0;
  std::map<std::string, int> endings;
  for (const auto& [seed, row] : rows_) {
    if (seed < first || seed > last) continue;
    flights += 1;
    endings[row.outcome] += 1;
    speed_sum += row.mean_speed_mps;
    blocked += row.obstacle_ahead;
    blocked_ompl += row.obstacle_ahead_ompl;
  }
  const int goals = endings["goal"];
  const Interval interval = wilson_interval(goals, flights);
  std::string text = fmt::format(
      "{} of {} reached the goal: {:.1f} % (95 % Wilson interval {:.1f} to {:.1f} %)\n", goals, flights,
      flights > 0 ? 100.0 * goals / flights : 0.0, 100 * interval.least, 100 * interval.greatest);
  for (const auto& [ending, count] : endings) text += fmt::format("  {:<18}{}\n", ending, count);
  if (flights > 0) text += fmt::format("  {:<18}{:.1f} m/s\n", "mean speed", speed_sum / flights);
  if (blocked > 0) {
    text += fmt::format("  {:<18}{} replans, {:.1f} % flown on OMPL's answer\n", "obstacle ahead", blocked,
                        100.0 * static_cast<double>(blocked_ompl) / static_cast<double>(blocked));
  }
  return text;
}

}  // namespace understory
