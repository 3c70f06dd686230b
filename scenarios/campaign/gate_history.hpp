#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/campaign/gate.hpp"

/// Several campaigns of one file, one after the other: how a project's flights went over its commits.
namespace understory {

/// One campaign among its neighbours.
struct HistoryEntry {
  std::string name;    ///< of its folder
  std::string commit;  ///< of the program that flew it
  int flown = 0, goals = 0;
  Interval success;                          ///< 95 %, Wilson's
  BootstrapEstimate speed_mps, clearance_m;  ///< means over flights, 95 %
  int pairs = 0;                             ///< of the same condition and seed in the campaign before
  double difference = 0;  ///< of the share of goals, to the campaign before, over these pairs
  std::string change;     ///< "fell", "rose"; empty: neither is shown
};

struct GateHistory {
  std::vector<HistoryEntry> entries;
};

/// Reads the campaigns in this order; a folder that is none stands for the campaigns in it, by their names. A
/// change is shown if its evidence reaches the number of changes looked at / alpha (Bonferroni). Throws
/// ScenarioError if there are fewer than two.
GateHistory history_of(const std::vector<std::string>& folders, const GateRule& rule);

/// A table, and where success changed.
std::string history_text(const GateHistory& history);

/// The curves over the campaigns, with intervals, and the table.
std::string history_page(const GateHistory& history, const std::filesystem::path& data_root);

}  // namespace understory
