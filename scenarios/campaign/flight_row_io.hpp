#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/campaign/flight_row.hpp"

namespace understory {

/// Of rows and of the folders that hold them: results of another one are refused.
constexpr int results_format = 1;

/// What a flight took on its machine: kept beside its row, since no two runs agree on it.
struct FlightCost {
  double wall_s = 0;
  double peak_memory_mb = 0;  ///< 10^6 bytes, resident
};

/// One flight's file: its row and its cost.
struct FlightFile {
  FlightRow row;
  FlightCost cost;
};

/// One line of JSON without its newline; numbers in full precision, null where there is nothing to say.
std::string to_json_line(const FlightRow& row);

/// A flight's file as JSON, and back: nothing where the text is not whole, or of another format.
std::string to_json(const FlightFile& file);
std::optional<FlightFile> flight_file_from_json(const std::string& text);

/// CSV with a header and a row per flight, six digits a number, empty where there is nothing to say.
std::string to_csv(const std::vector<FlightRow>& rows);
/// Reads it back. Throws ScenarioError, naming `name` and the line, where the columns are of another version
/// or a row is not whole.
std::vector<FlightRow> rows_from_csv(const std::string& text, const std::string& name);

}  // namespace understory
