#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/output/signals.hpp"

namespace understory {

/// Keeps a second program on this machine from writing into a folder; dropped however this one ends. A folder
/// that it made and nobody used goes with it.
class FolderLock {
 public:
  /// Makes the folder where there is none. Throws ScenarioError, which calls it by `name`, where it is taken
  /// or cannot be written.
  FolderLock(const std::filesystem::path& folder, const std::filesystem::path& name);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path folder_;
  int file_ = -1;
  std::optional<Unfinished> file_name_;
  bool is_new_ = false;
};

/// What a command may leave in its folder.
struct FolderContents {
  std::string manifest;  ///< the file that says how the others came about: scenario.yaml
  std::string manifest_text;
  /// Everything that may be there, by relative path, with '*': "overlays/*.png". The first says that all is
  /// there.
  std::vector<std::string> patterns;
};

/// What may be replaced in a folder that holds results already.
enum class Replace {
  nothing,
  same,     ///< results of the same manifest
  anything  ///< --force
};

/// A folder of results that appear whole or not at all: they are written into "FOLDER.part" and get their
/// names in finish(). One program at a time writes into a folder. What is there already and is not the
/// command's stays.
class OutputFolder {
 public:
  /// Throws ScenarioError in one line where the folder cannot be written, is being written by another
  /// program, or holds results that may not be replaced; MachineError where the disk is full.
  OutputFolder(std::filesystem::path folder, FolderContents contents, Replace replace);

  /// Where to write until then; holds the manifest.
  const std::filesystem::path& path() const { return part_->path(); }
  /// Puts what was written into the place of what was there.
  void finish();

 private:
  std::filesystem::path folder_;
  FolderContents contents_;
  std::optional<FolderLock> lock_;
  std::optional<Unfinished> part_;
};

}  // namespace understory
