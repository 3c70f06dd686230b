#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace understory {

/// What one thing costs for one pair, over all pairs and rounds.
struct BenchRow {
  std::string name;
  int threads = 1;
  double median_ms = 0;
  double p90_ms = 0;
  double p99_ms = 0;
  std::string yardstick;  ///< name of the row it is measured against; empty for a yardstick itself
  double ratio = 0;       ///< median over the yardstick's; 0 for a yardstick
};

/// One flight of the program, from its process's start to its end.
struct TimedFlight {
  double simulated_s = 0;
  double wall_s = 0;                           ///< the process's own, loading of libraries included
  double frames = 0;                           ///< stereo pairs
  std::map<std::string, double> stage_s = {};  ///< wall time per stage of the loop (FlightResult's timings)
  double peak_memory_mb = 0;                   ///< maximum resident set
  double cpu_s = 0;                            ///< the process's own
};

/// What flights of one kind cost.
struct ClosedLoopRow {
  std::string name;
  int processes = 1;  ///< side by side
  int flights = 0;
  double pairs_per_s = 0;          ///< stereo pairs, of all processes together, per second
  double cpu_per_simulated_s = 0;  ///< seconds of a core per simulated second: hardly minds other load
  double simulated_per_s = 0;  ///< simulated seconds, of all processes together, per second: real time is 1
  /// Of the flights' own wall time, by stage and "other"; they add up to 1.
  std::vector<std::pair<std::string, double>> shares;
  double peak_memory_mb = 0;  ///< of the greediest flight
  std::string yardstick;      ///< name of the row it is measured against; empty for a yardstick itself
  double ratio = 0;           ///< elapsed time per simulated second over the yardstick's; 0 for a yardstick
};

/// `elapsed_s`: from the first flight's start to the last one's end. `yardstick`: nullptr, or the row to
/// measure against.
ClosedLoopRow closed_loop_row(const std::string& name, int processes, const std::vector<TimedFlight>& flights,
                              double elapsed_s, const ClosedLoopRow* yardstick);

/// What a flight's result.json tells. Throws MachineError where it cannot be read.
TimedFlight timed_flight(const std::filesystem::path& result_file);

/// A table for a person, and the same as a JSON list of rows.
std::string to_table(const std::vector<BenchRow>& rows);
std::string to_json(const std::vector<BenchRow>& rows);
std::string to_table(const std::vector<ClosedLoopRow>& rows);
std::string to_json(const std::vector<ClosedLoopRow>& rows);

}  // namespace understory
