#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace understory {

/// The file in a folder of results that lists what this program wrote there, and of which kind of results it
/// is.
inline constexpr const char* claim_name = ".understory";

/// A folder that this program writes into. The file ".understory" in it lists what the program wrote there:
/// nothing else in the folder is ever replaced or removed. That file is locked, too, so that one program at a
/// time writes there. Whatever writes a file (OutputFile) asks the claims that are alive. Each kind of
/// results ("flight", "campaign") owns its files: a campaign does not replace those of a flight.
class FolderClaim {
 public:
  enum class Manner {
    alone,         ///< no other program may write there meanwhile
    beside_others  ///< adds a file or two, whoever else is at work
  };

  /// Makes the folder where there is none, and clears away what killed programs left in it unfinished. Throws
  /// ScenarioError, which calls the folder by `name`, where another program holds it, it cannot be written or
  /// ".understory" is a file of somebody else's.
  FolderClaim(const std::filesystem::path& folder, std::string kind, const std::filesystem::path& name,
              Manner manner = Manner::alone);
  /// Where nothing is listed, removes the folders that it made, as far as they are empty.
  ~FolderClaim();
  FolderClaim(const FolderClaim&) = delete;
  FolderClaim& operator=(const FolderClaim&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  /// Whether there are files in the folder, or below it, that are not ours.
  bool holds_other_files() const;
  /// Whether the file, a path below the folder, is listed under our kind.
  bool owns(const std::filesystem::path& file) const;
  /// Takes what is there and matches (fnmatch; '*' is no '/') for ours where nothing is listed yet: results
  /// of older programs, or copies without their hidden files. The list says so from the first file on that is
  /// written.
  void adopt(const std::vector<std::string>& patterns);
  /// Throws ScenarioError where something matches one of `patterns` that is not ours, or where a file stands
  /// in place of a folder that they need.
  void require_own(const std::vector<std::string>& patterns);
  /// The same of one file.
  void require_own(const std::filesystem::path& file);
  /// For results that a later run may go on with. Where the file `manifest` is there, adopts `patterns`; else
  /// the folder must hold no other files, unless `force`. Gives whether the manifest is there. Throws as
  /// require_own(patterns) does; `name` stands for the folder.
  bool resumes(const char* manifest, const std::vector<std::string>& patterns,
               const std::filesystem::path& name, bool force);
  /// Lists files that will be written now. Throws as require_own().
  void add(const std::vector<std::filesystem::path>& files);
  /// Removes what is ours, matches one of `patterns` and was not added by this object.
  void remove_stale(const std::vector<std::string>& patterns);
  /// Folders were made in it: they go with those that it made itself.
  void made_folders(const std::vector<std::filesystem::path>& folders);

 private:
  void lock(const std::filesystem::path& name, Manner manner);
  void read_list();
  void append(const std::string& lines);
  void let_go();

  std::filesystem::path folder_;  ///< canonical
  std::string kind_;
  int file_ = -1;
  bool is_locked_ = false;
  bool is_new_ = false;                         ///< we made ".understory"
  bool is_listed_ = false;                      ///< the file lists something
  std::map<std::string, std::string> written_;  ///< path to kind, of all kinds
  std::set<std::string> adopted_;               ///< of our kind, and not in the file yet
  std::set<std::string> added_;                 ///< by this object
  std::vector<std::filesystem::path> made_;     ///< folders, outermost first
};

/// The claim of the innermost folder that holds `file` (canonical); null where nobody claims it.
FolderClaim* claim_of(const std::filesystem::path& file);

/// Removes what programs left unfinished in `folder` that are alive no more.
void clear_unfinished(const std::filesystem::path& folder);

/// Makes a folder and those above it. Gives those that were not there before, outermost first. Throws as
/// OutputFile, calling the folder by `name`.
std::vector<std::filesystem::path> make_folders(const std::filesystem::path& folder,
                                                const std::filesystem::path& name);

/// Whether a relative path is what a pattern means (fnmatch; '*' is no '/').
bool matches(const std::filesystem::path& file, const std::vector<std::string>& patterns);

/// Every file below `folder` that a pattern means, by relative path, sorted.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder,
                                            const std::vector<std::string>& patterns);

}  // namespace understory
