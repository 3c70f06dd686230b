#include "scenarios/output/folder_claim.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fnmatch.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>

#include "scenarios/output/file_output.hpp"
#include "scenarios/output/signals.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view header =
    "Files that understory wrote here, each behind the kind of its results. It replaces no others.\n";

/// In the order in which they were made. The main thread changes it, under hold_outputs(); a signal's looks.
std::vector<FolderClaim*>& claims = *new std::vector<FolderClaim*>;

/// Whether the open file still bears that name.
bool is_file(int descriptor, const fs::path& name) {
  struct stat held {
  }, there{};
  return fstat(descriptor, &held) == 0 && stat(name.c_str(), &there) == 0 && held.st_ino == there.st_ino &&
         held.st_dev == there.st_dev;
}

/// The folder of the first part of a pattern: "worst" of "worst/*.png"; empty where the pattern has none.
std::string folder_in(const std::string& pattern) {
  const std::size_t slash = pattern.find('/');
  return slash == std::string::npos ? "" : pattern.substr(0, slash);
}

/// Whether another program is at work on `path`: each holds a lock on what it has not finished.
bool is_held(const fs::path& path) {
  if (is_at_work_on(path)) return true;  // perhaps about to take its lock
  std::error_code ignored;
  const fs::path file = fs::is_directory(path, ignored) ? path / claim_name : path;
  const int descriptor = open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) return errno != ENOENT || file == path;
  const bool is_free = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  close(descriptor);
  return !is_free;
}

}  // namespace

bool matches(const fs::path& file, const std::vector<std::string>& patterns) {
  return std::ranges::any_of(patterns, [&](const std::string& pattern) {
    return fnmatch(pattern.c_str(), file.c_str(), FNM_PATHNAME) == 0;
  });
}

std::vector<fs::path> files_of(const fs::path& folder, const std::vector<std::string>& patterns) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (auto entry = fs::recursive_directory_iterator(folder, ignored);
       entry != fs::recursive_directory_iterator(); entry.increment(ignored)) {
    const fs::path file = entry->path().lexically_relative(folder);
    if (!fs::is_directory(entry->symlink_status(ignored)) && matches(file, patterns)) files.push_back(file);
  }
  std::ranges::sort(files);
  return files;
}

std::vector<fs::path> make_folders(const fs::path& folder, const fs::path& name) {
  std::vector<fs::path> missing;
  std::error_code error, ignored;
  const fs::path whole = fs::absolute(folder).lexically_normal();
  for (fs::path above = whole.has_filename() ? whole : whole.parent_path();
       !above.empty() && !fs::exists(above, ignored) && above != above.parent_path();
       above = above.parent_path())
    missing.insert(missing.begin(), above);
  const auto lock = hold_outputs();
  fs::create_directories(folder, error);
  if (error) refuse_output(name, error.value());
  if (!fs::is_directory(folder, ignored)) refuse_output(name, ENOTDIR);
  return missing;
}

void clear_unfinished(const fs::path& folder) {
  std::error_code ignored;
  const auto lock = hold_outputs();
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (is_unfinished_name(entry.path()) && !is_held(entry.path())) left.push_back(entry.path());
  for (const fs::path& path : left) fs::remove_all(path, ignored);
}

FolderClaim* claim_of(const fs::path& file) {
  const auto lock = hold_outputs();
  FolderClaim* innermost = nullptr;
  for (FolderClaim* claim : claims) {
    const fs::path& folder = claim->folder();
    const bool holds =
        std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
    const bool is_deeper =
        innermost == nullptr || folder.native().size() >= innermost->folder().native().size();
    if (holds && is_deeper) innermost = claim;
  }
  return innermost;
}

FolderClaim::FolderClaim(const fs::path& folder, std::string kind, const fs::path& name, Manner manner)
    : kind_(std::move(kind)) {
  const auto hold = hold_outputs();
  try {
    for (;;) {
      const std::vector<fs::path> more = make_folders(folder, name);
      made_.insert(made_.end(), more.begin(), more.end());
      std::error_code error;
      folder_ = fs::canonical(folder, error);
      if (error) refuse_output(name, error.value());
      lock(name, manner);
      if (file_ >= 0) break;  // else another program removed it meanwhile
    }
    read_list(name);
  } catch (const InputError&) {
    let_go();
    throw;
  } catch (const MachineError&) {
    let_go();
    throw;
  }
  clear_unfinished(folder_);
  claims.push_back(this);
  at_signal(this, [this] { let_go(); });
}

void FolderClaim::lock(const fs::path& name, Manner manner) {
  const fs::path file = folder_ / claim_name;
  struct stat before {};
  is_new_ = lstat(file.c_str(), &before) != 0;
  if (!is_new_ && !S_ISREG(before.st_mode))
    throw ScenarioError(
        fmt::format("{}: expected a file of understory's, this is none: move it away", file.string()));
  file_ = open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0 && errno == ENOENT) return;
  if (file_ < 0) refuse_output(name, errno);
  is_locked_ = flock(file_, LOCK_EX | LOCK_NB) == 0;
  if (!is_locked_ && manner == Manner::alone && errno == EWOULDBLOCK) {
    is_new_ = false;
    throw ScenarioError(fmt::format("{}: another understory writes there at this moment", name.string()));
  }
  if (!is_file(file_, file)) {
    close(file_);
    file_ = -1;
  }
}

void FolderClaim::read_list(const fs::path& name) {
  std::string text;
  char piece[65536];
  for (ssize_t count; (count = pread(file_, piece, sizeof piece, static_cast<off_t>(text.size()))) > 0;)
    text.append(piece, static_cast<std::size_t>(count));
  if (text.empty()) {
    if (write(file_, header.data(), header.size()) != static_cast<ssize_t>(header.size()))
      refuse_output(name, errno);
    return;
  }
  if (!text.starts_with(header)) {
    is_new_ = false;
    throw ScenarioError(fmt::format("{}: expected a file of understory's, this is none: move it away",
                                    (folder_ / claim_name).string()));
  }
  std::size_t begin = header.size();
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string line = text.substr(begin, end - begin);
    const std::size_t blank = line.find(' ');
    if (blank == std::string::npos) continue;
    const fs::path path = line.substr(blank + 1);
    const bool lies_within = path.is_relative() && std::ranges::find(path, "..") == path.end();
    if (lies_within) written_[path.string()] = line.substr(0, blank);
  }
  if (begin < text.size() && write(file_, "\n", 1) != 1) refuse_output(name, errno);  // torn by a power cut
}

FolderClaim::~FolderClaim() {
  const auto hold = hold_outputs();
  std::erase(claims, this);
  forget_at_signal(this);
  let_go();
}

void FolderClaim::let_go() {
  const auto hold = hold_outputs();
  const fs::path file = folder_ / claim_name;
  const bool is_empty = written_.empty() || !is_saved_;  // in the file
  if (file_ >= 0 && is_new_ && is_locked_ && is_empty && is_file(file_, file)) ::unlink(file.c_str());
  if (file_ >= 0) close(file_);
  file_ = -1;
  if (!is_empty) return;
  for (auto made = made_.rbegin(); made != made_.rend(); ++made) ::rmdir(made->c_str());  // where it is empty
}

bool FolderClaim::holds_other_files() const {
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder_, ignored)) {
    const std::string file = entry.path().lexically_relative(folder_).string();
    const bool is_ours = file == claim_name || owns(entry.path());
    if (!is_ours && !fs::is_directory(entry.symlink_status(ignored))) return true;
  }
  return false;
}

bool FolderClaim::owns(const fs::path& file) const {
  const auto found = written_.find(file.lexically_relative(folder_).string());
  return found != written_.end() && found->second == kind_;
}

void FolderClaim::adopt(const std::vector<std::string>& patterns) {
  if (!written_.empty()) return;
  for (const fs::path& file : files_of(folder_, patterns)) {
    written_[file.string()] = kind_;
    is_saved_ = false;
  }
}

void FolderClaim::require_own(const std::vector<std::string>& patterns) const {
  std::error_code ignored;
  for (const std::string& pattern : patterns) {
    const fs::path within = folder_ / folder_in(pattern);
    const fs::file_status status = fs::symlink_status(within, ignored);
    if (!folder_in(pattern).empty() && fs::is_symlink(status))  // its files are not in this folder
      throw ScenarioError(fmt::format("{}: expected a folder, this is a link", within.string()));
    if (!folder_in(pattern).empty() && fs::exists(status) && !fs::is_directory(status))
      refuse_output(within, ENOTDIR);
    if (pattern.find('*') == std::string::npos && fs::is_directory(folder_ / pattern, ignored))
      refuse_output(folder_ / pattern, EISDIR);
  }
  for (const fs::path& file : files_of(folder_, patterns)) require_own(folder_ / file);
}

void FolderClaim::require_own(const fs::path& file) const {
  std::error_code ignored;
  if (owns(file) || !fs::exists(fs::symlink_status(file, ignored))) return;
  throw ScenarioError(
      fmt::format("{}: is there and is no {} of understory's: move it away, or name another folder with "
                  "--out",
                  file.string(), kind_));
}

void FolderClaim::note(const std::string& file) {
  if (const auto known = written_.find(file); known != written_.end() && known->second == kind_) return;
  if (!is_saved_) write_list();
  const std::string line = fmt::format("{} {}\n", kind_, file);
  if (write(file_, line.data(), line.size()) != static_cast<ssize_t>(line.size()))
    refuse_output(folder_ / file, errno);
  fdatasync(file_);  // whoever finds the file after a power cut must find whose it is
  written_[file] = kind_;
}

void FolderClaim::add(const fs::path& file) {
  const auto hold = hold_outputs();
  const std::string relative = file.lexically_relative(folder_).string();
  require_own(file);
  note(relative);
  added_.insert(relative);
}

void FolderClaim::remove_stale(const std::vector<std::string>& patterns) {
  const auto hold = hold_outputs();
  std::error_code ignored;
  std::set<fs::path> folders;
  for (auto file = written_.begin(); file != written_.end();) {
    const bool is_stale =
        file->second == kind_ && !added_.contains(file->first) && matches(file->first, patterns);
    if (is_stale) {
      fs::remove(folder_ / file->first, ignored);
      folders.insert((folder_ / file->first).parent_path());
    }
    file = is_stale ? written_.erase(file) : std::next(file);
  }
  for (const fs::path& folder : folders)
    if (folder != folder_) ::rmdir(folder.c_str());  // where it is empty
  write_list();
}

void FolderClaim::write_list() {
  is_saved_ = true;
  std::string text(header);
  for (const auto& [file, kind] : written_) text += fmt::format("{} {}\n", kind, file);
  if (ftruncate(file_, 0) != 0 || write(file_, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    refuse_output(folder_, errno);
}

void FolderClaim::list(const std::string& kind, const std::vector<fs::path>& files) {
  written_.clear();
  for (const fs::path& file : files) written_[file.string()] = kind;
  write_list();
}

void FolderClaim::made_folders(const std::vector<fs::path>& folders) {
  const auto hold = hold_outputs();
  made_.insert(made_.end(), folders.begin(), folders.end());
}

}  // namespace understory
