#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scenarios/output/result_kinds.hpp"
#include "scenarios/output/signals.hpp"

namespace understory {

/// The mark of a folder that this program writes into: the file ".understory" says of which kind the results
/// are and lists their names. It is locked, so that one program at a time writes there. Files that it does
/// not list are the user's: they are never replaced or removed.
class FolderMark {
 public:
  enum class Manner {
    alone,         ///< no other program may write there meanwhile
    beside_others  ///< adds a file or two, even while other programs write
  };

  /// Makes folder and mark where there are none. If results of a kind that grows lack only their mark, lists
  /// them anew: copies often lack hidden files. Throws ScenarioError, which calls the folder by `name`, if
  /// another program writes there, it cannot be written, or it is marked as results of another kind.
  FolderMark(const std::filesystem::path& folder, const ResultKind& kind, const std::filesystem::path& name,
             Manner manner = Manner::alone);
  /// Removes a mark that it made and that lists nothing, and folders that were made for it.
  ~FolderMark();
  FolderMark(const FolderMark&) = delete;
  FolderMark& operator=(const FolderMark&) = delete;

  const std::set<std::string>& files() const { return files_; }
  /// Throws ScenarioError, which names one, if there are files that the mark does not list. Folders below
  /// with a mark of their own are left out.
  void require_no_other_files() const;
  /// For results that grow: whether they were begun, which their manifest tells. Lists the kind's names.
  /// Throws ScenarioError if they were begun and nobody asked to go on (`resume`), or if another file is
  /// there that is not listed. Conditions of a campaign that was killed before its manifest was written may
  /// be there.
  bool goes_on(bool resume);
  /// Throws ScenarioError where the file, by relative path, is there and is not listed.
  void require_own(const std::string& file) const;
  /// Lists files that will be written now, or that were.
  void add(const std::vector<std::string>& files);
  /// Lists the kind's names. Throws as require_own() does.
  void add_names();
  /// Removes the listed files that are not in `kept` from folder and list.
  void keep_only(const std::set<std::string>& kept);

 private:
  bool opens(Manner manner);
  void read(const ResultKind& kind);
  void append(const std::string& lines);
  bool list(const std::vector<std::string>& files);  ///< whether one of them was not listed yet

  std::filesystem::path folder_;  ///< canonical
  std::filesystem::path name_;
  const ResultKind& kind_;
  std::set<std::string> files_;
  int file_ = -1;
  std::optional<Unfinished> unlisted_;  ///< the mark, until it lists something
};

/// Throws ScenarioError: the file is the user's.
[[noreturn]] void refuse_other_file(const std::filesystem::path& file);

/// Removes unfinished files and folders in `folder` of programs that no longer run.
void clear_unfinished(const std::filesystem::path& folder);

}  // namespace understory
