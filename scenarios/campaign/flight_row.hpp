#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/config/keys.hpp"
#include "scenarios/flight/flight_result.hpp"

namespace understory {

struct Scenario;

/// Of rows and of the folders that hold them: results of another format are refused.
inline constexpr int results_format = 2;

/// What became of one flight of a campaign.
enum class RunStatus {
  flown,    ///< to an outcome, good or bad
  crashed,  ///< the program broke: a signal of its own, or status 3
  hung,     ///< took longer than the campaign allows, and was stopped
  killed,   ///< by somebody else (SIGKILL, SIGTERM)
  refused   ///< the program refused its input
};

/// One flight of a campaign: a row of flights.csv, a line of flights.jsonl. Nothing in it depends on the
/// machine's speed, so that a campaign flown again gives the same rows. `id` is unique within a campaign.
struct FlightRow : FlightMeasures {
  std::string id;
  std::string condition;
  std::uint64_t seed = 0;
  RunStatus status = RunStatus::refused;
  std::string reason;
  std::string outcome;
  std::string renderer;
  double cruise_speed_mps = 0;
  double square_metres_per_tree = 0;
  double goal_m = 0;
  /// The last columns, which are not read back: keys of the campaign's grid, and the cause where flights are
  /// explained.
  std::vector<std::pair<std::string, std::string>> more = {};
  bool flown() const { return status == RunStatus::flown; }
  bool reached_goal() const { return flown() && outcome == "goal"; }
};

/// What a flight took on its machine: kept apart from its row, because it differs from run to run.
struct FlightCost {
  double wall_s = 0;
  double peak_memory_mb = 0;  ///< 10^6 bytes, resident
};

/// One flight's file: its row and its cost.
struct FlightFile {
  FlightRow row;
  FlightCost cost;
};

/// The row of a flight that came to an outcome: a condition's name and the seed are its id.
FlightRow flown_row(const std::string& condition, const Scenario& scenario, const FlightResult& result);

/// The columns of a row in their order, with unit and meaning.
std::vector<Key> flight_row_columns();

/// One line of JSON without its newline; numbers in full precision, null for missing values.
std::string to_json_line(const FlightRow& row);

/// A flight's file as JSON, and back: nothing where the text is not whole, or of another format.
std::string to_json(const FlightFile& file);
std::optional<FlightFile> flight_file_from_json(const std::string& text);

/// CSV with a header and a row per flight, six digits a number, empty for missing values.
std::string to_csv(const std::vector<FlightRow>& rows);
/// Reads it back. Throws ScenarioError, naming `name` and the line, where the columns are of another version
/// or a row is not whole.
std::vector<FlightRow> rows_from_csv(const std::string& text, const std::string& name);

}  // namespace understory
