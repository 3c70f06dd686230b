#include "scenarios/output/folder_mark.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>

#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view header =
    "Files that understory wrote here, each behind the kind of its results. It replaces no others.\n";

/// In place of a kind: the file was removed. The list only grows, so that a kill leaves what it said before.
constexpr std::string_view gone = "gone";

/// Whether the open file still bears that name.
bool is_file(int descriptor, const fs::path& name) {
  struct stat held {
  }, there{};
  return fstat(descriptor, &held) == 0 && stat(name.c_str(), &there) == 0 && held.st_ino == there.st_ino &&
         held.st_dev == there.st_dev;
}

[[noreturn]] void refuse_foreign(const fs::path& file) {
  throw ScenarioError(fmt::format("{}: understory did not write this file: move it away", file.string()));
}

std::string text_of(int descriptor) {
  std::string text;
  char piece[65536];
  for (ssize_t count; (count = pread(descriptor, piece, sizeof piece, static_cast<off_t>(text.size()))) > 0;)
    text.append(piece, static_cast<std::size_t>(count));
  return text;
}

/// Whether a program that is alive no more left what bears an unfinished name: it held a lock on the file, or
/// on the folder's mark.
bool is_left_over(const fs::path& path) {
  std::error_code ignored;
  const bool is_folder = fs::is_directory(fs::symlink_status(path, ignored));
  if (is_folder && !fs::exists(path / mark_name, ignored)) return fs::is_empty(path, ignored);
  if (!is_folder && !is_unfinished_file_name(path)) return false;
  const fs::path file = is_folder ? path / mark_name : path;
  const int descriptor = open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) return false;
  const bool is_free = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  close(descriptor);
  return is_free;
}

}  // namespace

void refuse_other_file(const fs::path& file) {
  throw ScenarioError(
      fmt::format("{}: must not be in a folder of results: move it away, or name another folder with --out",
                  file.string()));
}

void clear_unfinished(const fs::path& folder) {
  std::error_code ignored;
  const auto lock = hold_outputs();
  std::vector<fs::path> left;
  fs::directory_iterator entry(folder, ignored);
  for (; !ignored && entry != fs::directory_iterator(); entry.increment(ignored))
    if (is_unfinished_name(entry->path()) && is_left_over(entry->path())) left.push_back(entry->path());
  for (const fs::path& path : left) remove_unfinished(path);
}

FolderMark::FolderMark(const fs::path& folder, const ResultKind& kind, const fs::path& name, Manner manner)
    : name_(name), kind_(kind) {
  const auto hold = hold_outputs();
  try {
    std::error_code error;
    do {
      make_folders(folder, name);
      folder_ = fs::canonical(folder, error);
      if (error && error != std::errc::no_such_file_or_directory) refuse_output(name, error.value());
    } while (error || !opens(manner));  // another program removed it meanwhile
    read(kind);
  } catch (const std::exception&) {
    unlisted_.reset();
    if (file_ >= 0) close(file_);
    remove_made_folders();
    throw;
  }
  clear_unfinished(folder_);
}

bool FolderMark::opens(Manner manner) {
  const fs::path file = folder_ / mark_name;
  struct stat before {};
  const bool is_new = lstat(file.c_str(), &before) != 0;
  if (!is_new && !S_ISREG(before.st_mode)) refuse_foreign(file);
  file_ = open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0 && errno == ENOENT) return false;
  if (file_ < 0) refuse_output(name_, errno);
  const bool is_locked = flock(file_, LOCK_EX | LOCK_NB) == 0;
  if (!is_locked && manner == Manner::alone && errno == EWOULDBLOCK)
    throw ScenarioError(fmt::format("{}: another understory writes there at this moment", name_.string()));
  if (is_new && is_locked) unlisted_.emplace(file);
  if (is_file(file_, file)) return true;
  close(file_);
  file_ = -1;
  unlisted_.reset();
  return false;
}

void FolderMark::read(const ResultKind& kind) {
  const fs::path file = folder_ / mark_name;
  const std::string text = text_of(file_);
  if (header.starts_with(text))
    append(std::string(header.substr(text.size())));  // new, or torn by a power cut
  else if (!text.starts_with(header))
    refuse_foreign(file);
  std::size_t begin = header.size();
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string line = text.substr(begin, end - begin);
    const std::size_t blank = line.find(' ');
    if (blank == std::string::npos) continue;
    const std::string word = line.substr(0, blank), listed = line.substr(blank + 1);
    const fs::path path = listed;
    if (word == gone)
      files_.erase(listed);
    else if (word != kind.name)
      throw ScenarioError(fmt::format("{}: holds results of another kind ({}): --out names another folder",
                                      name_.string(), word));
    else if (path.is_relative() && std::ranges::find(path, "..") == path.end())
      files_.insert(listed);
  }
  if (begin < text.size()) append("\n");  // torn by a power cut
  if (files_.empty() && kind.grows && fs::exists(folder_ / kind.manifest)) list(files_of(folder_, kind));
}

void FolderMark::append(const std::string& lines) {
  if (write(file_, lines.data(), lines.size()) != static_cast<ssize_t>(lines.size()))
    refuse_output(folder_ / mark_name, errno);
}

FolderMark::~FolderMark() {
  const auto hold = hold_outputs();
  const bool lists_nothing = unlisted_.has_value();
  if (lists_nothing && !is_file(file_, folder_ / mark_name)) unlisted_->keep();  // it is another program's
  unlisted_.reset();
  close(file_);
  if (lists_nothing) remove_made_folders();
}

void FolderMark::require_no_other_files() const {
  const auto other = find_below(folder_, [&](const std::string& file) { return !files_.contains(file); });
  if (other) refuse_other_file(name_ / *other);
}

bool FolderMark::goes_on(bool resume) {
  const bool is_there = fs::exists(folder_ / kind_.manifest);
  if (is_there && !resume)
    throw ScenarioError(
        fmt::format("{}: holds a {} already: --resume goes on with it, --out names another folder",
                    name_.string(), kind_.name));
  const bool was_begun =
      !files_.empty();  // and killed before the manifest, which comes behind the conditions
  const auto other = is_there ? std::nullopt : find_below(folder_, [&](const std::string& file) {
    return !was_begun || !file.starts_with("conditions/");
  });
  if (other) refuse_other_file(name_ / *other);
  add_names();
  return is_there;
}

void FolderMark::require_own(const std::string& file) const {
  std::error_code ignored;
  if (!files_.contains(file) && fs::exists(fs::symlink_status(folder_ / file, ignored)))
    refuse_other_file(name_ / file);
}

void FolderMark::add_names() {
  const std::vector<std::string> names = names_of(kind_);
  for (const std::string& file : names) require_own(file);
  add(names);
}

bool FolderMark::list(const std::vector<std::string>& files) {
  std::string lines;
  for (const std::string& file : files)
    if (files_.insert(file).second) lines += fmt::format("{} {}\n", kind_.name, file);
  if (!lines.empty()) append(lines);
  return !lines.empty();
}

void FolderMark::add(const std::vector<std::string>& files) {
  const auto hold = hold_outputs();
  if (!list(files)) return;
  fdatasync(file_);  // whoever finds a file after a power cut must find whose it is
  if (unlisted_) unlisted_->keep();
  unlisted_.reset();
}

void FolderMark::keep_only(const std::set<std::string>& kept) {
  const auto hold = hold_outputs();
  std::error_code ignored;
  std::string lines;
  for (auto file = files_.begin(); file != files_.end();) {
    const bool is_stale = !kept.contains(*file);
    if (is_stale) {
      fs::remove(folder_ / *file, ignored);
      for (fs::path above = (folder_ / *file).parent_path(); above != folder_; above = above.parent_path())
        if (::rmdir(above.c_str()) != 0) break;  // it is not empty
      lines += fmt::format("{} {}\n", gone, *file);
    }
    file = is_stale ? files_.erase(file) : std::next(file);
  }
  if (lines.empty()) return;
  append(lines);
  fdatasync(file_);
}

}  // namespace understory
