#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/output/folder_claim.hpp"
#include "scenarios/output/signals.hpp"

namespace understory {

/// A folder for what is not finished: made empty, gone with this object, whatever is in it. One program at a
/// time works on `target`.
class UnfinishedFolder {
 public:
  /// `kind`: of what is made. `within`: in the target's folder itself, where nothing can be made beside it.
  /// Throws ScenarioError, which calls the target by `name`, where another program works on it, or where it
  /// cannot be written.
  UnfinishedFolder(const std::filesystem::path& target, const std::string& kind,
                   const std::filesystem::path& name, bool within = false);
  const std::filesystem::path& path() const { return part_->path(); }
  /// Lists what `patterns` mean, and gives it its name where that is free or an empty folder; false where
  /// something is in the way. From then on it outlives a power cut.
  bool become(const std::filesystem::path& name, const std::vector<std::string>& patterns);

 private:
  std::optional<FolderClaim> claim_;
  std::optional<Unfinished> part_;
};

/// What a command may leave in its folder, and of what kind that is (FolderClaim).
struct FolderContents {
  std::string kind;
  std::string manifest;  ///< the file that says how the others came about: scenario.yaml; empty: none
  std::string manifest_text;
  /// Everything that may be there, by relative path, with '*': "overlays/*.png". The first says that all is
  /// there.
  std::vector<std::string> patterns;
};

/// What may be replaced in a folder that holds results of that kind already.
enum class Replace {
  nothing,
  same,     ///< results of the same manifest
  anything  ///< --force
};

/// A folder of results that appear whole or not at all: they are written into an UnfinishedFolder and get
/// their names in finish(), which returns when they would outlive a power cut. One program at a time writes
/// into a folder. What is there already and is not of the kind stays.
class OutputFolder {
 public:
  /// Throws ScenarioError in one line where the folder cannot be written, is being written by another
  /// program, or holds files of these names that may not be replaced; MachineError where the disk is full.
  OutputFolder(std::filesystem::path folder, FolderContents contents, Replace replace);

  /// Where to write until then; holds the manifest.
  const std::filesystem::path& path() const { return part_->path(); }
  /// Puts what was written into the place of what was there.
  void finish();

 private:
  std::filesystem::path folder_;
  FolderContents contents_;
  Replace replace_;
  std::optional<FolderClaim> there_;  ///< of the folder that was there already
  std::optional<UnfinishedFolder> part_;
};

}  // namespace understory
