#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// What commands leave in their folders. Help and manual show this table; tests hold commands and pages to
/// it.
namespace understory {

/// One kind of results, all in one folder.
struct ResultKind {
  std::string_view name;
  std::string_view commands;  ///< that make such a folder: "fly record"
  /// The file that says how the others came about; empty: none.
  std::string_view manifest;
  /// The file that says that all are there.
  std::string_view last;
  bool grows = false;  ///< a later command goes on with it, where the manifest is there
  /// Relative paths of all that may be there, with '*' for a part of a name.
  std::vector<std::string> patterns;
  std::vector<std::string> added = {};  ///< names that report and mcap add
};

extern const ResultKind flight_results, campaign_results, tuning_results, evaluation_results,
    detection_results;

/// The kind of results that a command of that name makes; null where it makes no folder.
const ResultKind* results_of(std::string_view command);

/// The patterns that are whole names.
std::vector<std::string> names_of(const ResultKind& kind);

/// Throws ScenarioError where `output` would be one of the files in `folder` that results of any kind may
/// have there, but for those called `allowed`. An empty output is none.
void require_outside(const std::filesystem::path& output, const std::filesystem::path& folder,
                     std::string_view allowed = "");

/// Every file below `folder` that a pattern means, by relative path, sorted.
std::vector<std::string> files_of(const std::filesystem::path& folder, const ResultKind& kind);

}  // namespace understory
