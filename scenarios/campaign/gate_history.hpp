#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/campaign/gate.hpp"

namespace understory {

/// Several campaigns of one file, one after the other: how a project's flights went over its commits.
struct GateHistory {
  std::vector<ComparedCampaign> campaigns;
  std::vector<ConditionComparison>
      changes;                     ///< of each campaign but the first to the one before it, all pairs
  std::vector<std::string> shown;  ///< of each change: "fell", "rose"; empty: neither is shown
};

/// Reads the campaigns in this order; a folder that is none stands for the campaigns in it, by their names. A
/// change is shown if its evidence reaches i (i + 1) / alpha for the i-th, of a rise and of a fall each half:
/// over all changes, also those to come, one that is none is shown with probability alpha. Throws
/// ScenarioError if there are fewer than two.
GateHistory history_of(const std::vector<std::string>& folders, const GateRule& rule);

/// A table, and where success changed.
std::string history_text(const GateHistory& history);

/// The curves over the campaigns, with intervals, and the table.
std::string history_page(const GateHistory& history, const std::filesystem::path& data_root);

}  // namespace understory
