#include "scenarios/evaluation/flight_table.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "scenarios/evaluation/wilson.hpp"
#include "scenarios/file_output.hpp"

namespace understory {
namespace {

constexpr const char* header =
    "seed,outcome,distance_m,progress_m,mean_speed_mps,min_clearance_m,position_error_mean_m,position_error_"
    "max_m,"
    "detections,remembered_points,replans,straight,solved,kept,fallback,searches,found,least_points_on_a_bar,"
    "simulated_s,wall_s,"
    "digest,configuration\n";
enum Column {
  seed_column = 0,
  outcome_column = 1,
  speed_column = 4,
  solved_column = 12,
  kept_column = 13,
  fallback_column = 14,
  searches_column = 15,
  found_column = 16,
  column_count = 22
};

std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream stream(row);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

std::string number(const nlohmann::json& value) {
  return value.is_null() ? "" : fmt::format("{:.4g}", value.get<double>());
}

/// Empty where the course is no short list of bars.
std::string least_points(const nlohmann::json& result) {
  if (!result.contains("points_on_obstacles")) return "";
  std::int64_t least = -1;
  for (const auto& count : result["points_on_obstacles"]) {
    least = least < 0 ? count.get<std::int64_t>() : std::min(least, count.get<std::int64_t>());
  }
  return fmt::format("{}", least);
}

}  // namespace

void FlightTable::add_row(const std::string& text) {
  const std::vector<std::string> cells = cells_of(text);
  if (cells.size() != column_count || cells.back() != configuration_) return;
  rows_[std::stoull(cells[seed_column])] = {text,
                                            cells[outcome_column],
                                            std::stod(cells[speed_column]),
                                            std::stoll(cells[solved_column]),
                                            std::stoll(cells[kept_column]),
                                            std::stoll(cells[fallback_column]),
                                            std::stoll(cells[searches_column]),
                                            std::stoll(cells[found_column])};
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
  const nlohmann::json& replans = r["replans"];
  add_row(fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
                      r["seed"].get<std::uint64_t>(), r["outcome"].get<std::string>(),
                      number(r["distance_m"]), number(r["progress_m"]), number(r["mean_speed_mps"]),
                      number(r["min_clearance_m"]), number(r["estimation"]["position_error_mean_m"]),
                      number(r["estimation"]["position_error_max_m"]), r["detections"].get<std::int64_t>(),
                      r["remembered_points"].get<std::int64_t>(), replans["count"].get<std::int64_t>(),
                      replans["straight"].get<std::int64_t>(), replans["solved"].get<std::int64_t>(),
                      replans["kept"].get<std::int64_t>(), replans["fallback"].get<std::int64_t>(),
                      replans["searches"].get<std::int64_t>(), replans["searches_found"].get<std::int64_t>(),
                      least_points(r), number(r["simulated_s"]), number(r["wall_s"]),
                      r["digest"].get<std::string>(), configuration_));
}

std::string FlightTable::to_csv() const {
  std::string text = header;
  for (const auto& [seed, row] : rows_) text += row.text + "\n";
  return text;
}

std::string FlightTable::summary(std::uint64_t first, std::uint64_t last) const {
  int flights = 0;
  double speed_sum = 0;
  std::int64_t solved = 0, kept = 0, fallback = 0, searches = 0, found = 0;
  std::map<std::string, int> endings;
  for (const auto& [seed, row] : rows_) {
    if (seed < first || seed > last) continue;
    flights += 1;
    endings[row.outcome] += 1;
    speed_sum += row.mean_speed_mps;
    solved += row.solved;
    kept += row.kept;
    fallback += row.fallback;
    searches += row.searches;
    found += row.found;
  }
  const int goals = endings["goal"];
  const Interval interval = wilson_interval(goals, flights);
  std::string text = fmt::format(
      "{} of {} reached the goal: {:.1f} % (95 % Wilson interval {:.1f} to {:.1f} %)\n", goals, flights,
      flights > 0 ? 100.0 * goals / flights : 0.0, 100 * interval.least, 100 * interval.greatest);
  for (const auto& [ending, count] : endings) text += fmt::format("  {:<18}{}\n", ending, count);
  if (flights > 0) text += fmt::format("  {:<18}{:.1f} m/s\n", "mean speed", speed_sum / flights);
  if (const std::int64_t blocked = solved + kept + fallback; blocked > 0) {
    text += fmt::format(
        "  {:<18}{} with an obstacle ahead: {:.0f} % solved, {:.0f} % kept, {:.0f} % fallback\n", "replans",
        blocked, 100.0 * solved / blocked, 100.0 * kept / blocked, 100.0 * fallback / blocked);
    if (searches > 0)
      text +=
          fmt::format("  {:<18}{}, {:.0f} % answered\n", "OMPL searches", searches, 100.0 * found / searches);
  }
  return text;
}

}  // namespace understory
