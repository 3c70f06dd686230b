#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scenarios/output/folder_mark.hpp"
#include "scenarios/output/signals.hpp"

namespace understory {

/// A folder for unfinished results: made empty, and removed with all its content when this object ends. One
/// program at a time works on `target`.
class UnfinishedFolder {
 public:
  /// `within`: it is made in the target, because nothing can be made beside that. Throws ScenarioError, which
  /// calls the target by `name`, if another program works on it, or where it cannot be written.
  UnfinishedFolder(const std::filesystem::path& target, const ResultKind& kind,
                   const std::filesystem::path& name, bool within = false);
  ~UnfinishedFolder();
  const std::filesystem::path& path() const { return part_->path(); }
  FolderMark& mark() { return *mark_; }
  /// Renames it to `name`, if that is free or an empty folder; false if something is in the way.
  bool rename_to(const std::filesystem::path& name);

 private:
  std::optional<FolderMark> mark_;
  std::optional<Unfinished> part_;
};

/// What may be replaced in a folder that holds results of that kind already.
enum class Replace {
  nothing,
  same,     ///< results of the same manifest
  anything  ///< --force
};

/// A folder of results that appear whole or not at all: they are written into an UnfinishedFolder and get
/// their names in finish(), which returns when they would outlive a power cut. One program at a time writes
/// into a folder. The folder must be new, empty, or hold results of the kind and nothing else.
class OutputFolder {
 public:
  /// `manifest`: the text of the kind's manifest, where it has one. Throws ScenarioError in one line where
  /// the folder cannot be written, is being written by another program, or may not be replaced; MachineError
  /// where the disk is full.
  OutputFolder(std::filesystem::path folder, const ResultKind& kind, std::string manifest, Replace replace);

  /// Where to write until finish(); holds the manifest.
  const std::filesystem::path& path() const { return part_->path(); }
  /// Replaces the results that were there by what was written.
  void finish();

 private:
  void require_replaceable() const;
  void place(const std::vector<std::string>& written);

  std::filesystem::path folder_, name_;  ///< links followed; as given
  const ResultKind& kind_;
  std::string manifest_;
  Replace replace_;
  std::optional<FolderMark> there_;  ///< of the folder that was there already
  bool stands_alone_ = false;
  std::optional<UnfinishedFolder> part_;
};

}  // namespace understory
