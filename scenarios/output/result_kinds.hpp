#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// The files that commands leave in their folders. Help and manual show this table; tests compare commands
/// and pages with it.
namespace understory {

/// One kind of results, all in one folder.
struct ResultKind {
  std::string_view name;
  std::string_view commands;  ///< that make such a folder: "fly record"
  /// The file that says how the others came about; empty: none.
  std::string_view manifest;
  /// The file that says that all are there.
  std::string_view last;
  bool grows = false;  ///< a later command continues it, if the manifest is there
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

/// Throws ScenarioError if `output` is one of the files that results of any kind may have in `folder`, except
/// those called `allowed`. An empty output: none.
void require_outside(const std::filesystem::path& output, const std::filesystem::path& folder,
                     std::string_view allowed = "");

/// Every file below `folder` that matches a pattern, by relative path, sorted.
std::vector<std::string> files_of(const std::filesystem::path& folder, const ResultKind& kind);

}  // namespace understory
