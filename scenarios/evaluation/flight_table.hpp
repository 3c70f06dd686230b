#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace understory {

/// Results of one scenario over many seeds, one CSV row each. A row belongs to a configuration: a fingerprint
/// of the effective scenario and of the program, so that rows of another one are never taken for answers.
class FlightTable {
 public:
  explicit FlightTable(std::string configuration) : configuration_(std::move(configuration)) {}

  /// Takes over the rows of `file` that belong to this configuration; a missing file has none.
  void read(const std::filesystem::path& file);
  /// Takes one flight's result.json. Throws MachineError where it is missing or not whole.
  void add_result(const std::filesystem::path& result_json);
  bool has(std::uint64_t seed) const { return rows_.contains(seed); }
  /// Sorted by seed, with a header.
  std::string to_csv() const;
  /// Success with its Wilson interval and the endings, over the seeds first .. last; a few lines for a
  /// person.
  std::string summary(std::uint64_t first, std::uint64_t last) const;

 private:
  struct Row {
    std::string text;  ///< as in the file
    std::string outcome;
    double mean_speed_mps = 0;
    std::int64_t obstacle_ahead = 0, obstacle_ahead_ompl = 0;  ///< replans
  };
  void add_row(const std::string& text);

  std::string configuration_;
  std::map<std::uint64_t, Row> rows_;
};

}  // namespace understory
