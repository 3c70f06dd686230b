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

void empty(const fs::path& part) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(part, ignored))
    if (entry.path().filename() != claim_name) fs::remove_all(entry.path(), ignored);
}

void refuse_to_replace(const fs::path& folder, const fs::path& given, const FolderContents& contents,
                       Replace replace) {
  const std::vector<fs::path> held = files_of(folder, contents.patterns);
  if (held.empty()) return;
  const auto refuse = [&](const std::string& what) {
    throw ScenarioError(fmt::format("{}: {}", given.string(), what));
  };
  if (replace == Replace::nothing)
    refuse("holds results already: --force replaces them, --out names another folder");
  if (replace == Replace::same && fs::is_regular_file(folder / contents.manifest) &&
      read_file(folder / contents.manifest, maximum_json_bytes) != contents.manifest_text)
    refuse(fmt::format(
        "holds results of another configuration ({}): --force replaces them, --out names another folder",
        contents.manifest));
}

}  // namespace

UnfinishedFolder::UnfinishedFolder(const fs::path& target, const std::string& kind, const fs::path& name,
                                   bool within) {
  const fs::path above = within ? target : target.parent_path();
  const fs::path part = unfinished_name_of(target, above);
  const auto lock = hold_outputs();
  std::error_code ignored;
  const bool is_foreign = fs::exists(fs::symlink_status(part, ignored)) &&
                          !fs::exists(part / claim_name, ignored) &&
                          !(fs::is_directory(part, ignored) && fs::is_empty(part, ignored));
  if (is_foreign)
    throw ScenarioError(fmt::format("{}: understory did not write this folder: move it away", part.string()));
  claim_.emplace(part, kind, name);
  part_.emplace(part);
  empty(part);
}

bool UnfinishedFolder::become(const fs::path& name, const std::vector<std::string>& patterns) {
  const auto lock = hold_outputs();
  claim_->adopt(patterns);
  claim_->add({});
  sync_file_system(path());
  if (std::rename(path().c_str(), name.c_str()) == 0) {
    part_->keep();
    sync_folder(name.parent_path());
    return true;
  }
  if (errno != ENOTEMPTY && errno != EEXIST) refuse_output(name, errno);
  return false;
}

OutputFolder::OutputFolder(fs::path folder, FolderContents contents, Replace replace)
    : folder_(resolved(folder)), contents_(std::move(contents)), replace_(replace) {
  std::error_code ignored;
  if (fs::exists(folder_, ignored) && !fs::is_directory(folder_, ignored)) refuse_output(folder, ENOTDIR);
  part_.emplace(folder_, contents_.kind, folder, stands_alone(folder_));
  if (fs::exists(folder_, ignored)) {
    there_.emplace(folder_, contents_.kind, folder);
    there_->require_own(contents_.patterns);
    refuse_to_replace(folder_, folder, contents_, replace);
  }
  if (!contents_.manifest.empty()) write_whole_file(path() / contents_.manifest, contents_.manifest_text);
}

void OutputFolder::finish() {
  const auto lock = hold_outputs();  // no signal comes between
  const std::vector<fs::path> written = files_of(path(), contents_.patterns);
  if (!there_ && part_->become(folder_, contents_.patterns)) return;
  sync_file_system(path());
  if (!there_) {  // somebody made it meanwhile
    there_.emplace(folder_, contents_.kind, folder_, FolderClaim::Manner::beside_others);
    refuse_to_replace(folder_, folder_, contents_, replace_);
  }
  FolderClaim& there = *there_;
  there.require_own(contents_.patterns);
  // While it is replaced, the file that says that all is there is not.
  const fs::path mark = contents_.patterns.front();
  std::vector<fs::path> files;
  for (const fs::path& file : written) files.push_back(folder_ / file);
  there.add(files);
  if (there.owns(folder_ / mark)) fs::remove(folder_ / mark);
  const auto place = [&](const fs::path& file) {
    fs::create_directories((folder_ / file).parent_path());
    fs::rename(path() / file, folder_ / file);
  };
  for (const fs::path& file : written)
    if (file != mark) place(file);
  there.remove_stale(contents_.patterns);
  sync_file_system(folder_);
  if (std::ranges::find(written, mark) != written.end()) place(mark);
  sync_folder(folder_);
}

}  // namespace understory
