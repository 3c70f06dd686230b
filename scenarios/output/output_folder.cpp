#include "scenarios/output/output_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// Whether nothing can be made beside the folder and moved into it, which a mount in between prevents, too:
/// then what is unfinished lies within.
bool stands_alone(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) return false;
  const Unfinished beside(unfinished_name_in(folder.parent_path())), within(unfinished_name_in(folder));
  const int file = open(beside.path().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return true;
  close(file);
  return std::rename(beside.path().c_str(), within.path().c_str()) != 0;
}

/// With every symbolic link followed, so that the links stay.
fs::path resolved(const fs::path& folder) {
  std::error_code error, ignored;
  fs::path path = fs::weakly_canonical(fs::absolute(folder), error);
  for (int links = 0; !error && fs::is_symlink(path, ignored) && links < 40;
       ++links)  // one that leads to nothing yet
    path = fs::weakly_canonical(path.parent_path() / fs::read_symlink(path, error), error);
  if (error) refuse_output(folder, error.value());
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

UnfinishedFolder::UnfinishedFolder(const fs::path& target, const ResultKind& kind, const fs::path& name,
                                   bool within) {
  const fs::path above = within ? target : target.parent_path();
  const fs::path part = unfinished_name_of(target, above);
  const auto lock = hold_outputs();
  clear_unfinished(above);
  std::error_code ignored;
  const bool is_foreign = fs::exists(fs::symlink_status(part, ignored)) &&
                          !fs::exists(part / mark_name, ignored) &&
                          !(fs::is_directory(part, ignored) && fs::is_empty(part, ignored));
  if (is_foreign)
    throw ScenarioError(fmt::format("{}: understory did not write this folder: move it away", part.string()));
  mark_.emplace(part, kind, name);
  part_.emplace(part);
  mark_->add({std::string(kind.last)});  // so that the mark goes with the folder, as its last file
}

UnfinishedFolder::~UnfinishedFolder() {
  part_.reset();
  mark_.reset();
  remove_made_folders();
}

bool UnfinishedFolder::rename_to(const fs::path& name) {
  if (std::rename(path().c_str(), name.c_str()) != 0) {
    if (errno != ENOTEMPTY && errno != EEXIST) refuse_output(name, errno);
    return false;
  }
  part_->keep();
  sync_folder(name.parent_path());
  return true;
}

OutputFolder::OutputFolder(fs::path folder, const ResultKind& kind, std::string manifest, Replace replace)
    : folder_(resolved(folder)),
      name_(std::move(folder)),
      kind_(kind),
      manifest_(std::move(manifest)),
      replace_(replace) {
  std::error_code ignored;
  // Asked once: another program may remove the folder between two questions.
  const fs::file_status status = fs::status(folder_, ignored);
  if (fs::exists(status) && !fs::is_directory(status)) refuse_output(name_, ENOTDIR);
  stands_alone_ = stands_alone(folder_);
  part_.emplace(folder_, kind_, name_, stands_alone_);
  if (fs::exists(folder_, ignored)) {
    if (fs::exists(fs::symlink_status(folder_ / mark_name, ignored))) there_.emplace(folder_, kind_, name_);
    require_replaceable();
  }
  if (!kind_.manifest.empty()) write_whole_file(path() / kind_.manifest, manifest_);
}

void OutputFolder::require_replaceable() const {
  const auto refuse = [&](const std::string& reason) {
    throw ScenarioError(fmt::format("{}: {}", name_.string(), reason));
  };
  for (const std::string& file : names_of(kind_))
    if (fs::is_directory(fs::symlink_status(folder_ / file))) refuse_output(name_ / file, EISDIR);
  if (!there_) {
    const auto other = find_below(folder_, [](const std::string&) { return true; });
    if (other) refuse_other_file(name_ / *other);
    return;
  }
  there_->require_no_other_files();
  if (there_->files().empty()) return;
  if (replace_ == Replace::nothing)
    refuse("holds results already: --force replaces them, --out names another folder");
  if (replace_ == Replace::same && fs::is_regular_file(folder_ / kind_.manifest) &&
      read_file(folder_ / kind_.manifest, maximum_json_bytes) != manifest_)
    refuse(fmt::format(
        "holds results of another configuration ({}): --force replaces them, --out names another folder",
        kind_.manifest));
}

void OutputFolder::finish() {
  const auto lock = hold_outputs();  // no signal comes between
  const std::vector<std::string> written = files_below(path());
  part_->mark().add(written);
  sync_file_system(path());
  if (!there_ && !stands_alone_ && part_->rename_to(folder_)) return;
  if (!there_) there_.emplace(folder_, kind_, name_);  // it is a mount, or somebody made something there
  require_replaceable();
  place(written);
}

/// File by file. While they are replaced, the file that says that all are there is not.
void OutputFolder::place(const std::vector<std::string>& written) {
  if (there_->files().contains(std::string(kind_.last))) fs::remove(folder_ / kind_.last);
  there_->keep_only({written.begin(), written.end()});
  there_->add(written);
  const auto place_one = [&](const fs::path& file) {
    fs::create_directories((folder_ / file).parent_path());
    fs::rename(path() / file, folder_ / file);
  };
  for (const std::string& file : written)
    if (file != kind_.last) place_one(file);
  sync_file_system(folder_);
  if (std::ranges::find(written, kind_.last) != written.end()) place_one(kind_.last);
  sync_folder(folder_);
}

}  // namespace understory
