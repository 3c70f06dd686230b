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

/// In place of a kind: the file was removed. The list only grows, so that a kill leaves what it said before.
constexpr std::string_view gone = "gone";

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

/// Whether a program that is alive no more left what bears an unfinished name. Each holds a lock on what it
/// has not finished; a folder without our list is somebody else's, unless the program ended before it made
/// one.
bool is_left_over(const fs::path& path) {
  if (is_at_work_on(path)) return false;  // perhaps about to take its lock
  std::error_code ignored;
  const bool is_folder = fs::is_directory(fs::symlink_status(path, ignored));
  if (is_folder && !fs::exists(path / claim_name, ignored)) return fs::is_empty(path, ignored);
  if (!is_folder && !is_unfinished_file_name(path)) return false;
  const fs::path file = is_folder ? path / claim_name : path;
  const int descriptor = open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) return false;
  const bool is_free = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  close(descriptor);
  return is_free;
}

}  // namespace

bool matches(const fs::path& file, const std::vector<std::string>& patterns) {
  return std::ranges::any_of(patterns, [&](const std::string& pattern) {
    return fnmatch(pattern.c_str(), file.c_str(), FNM_PATHNAME) == 0;
  });
}

namespace {

/// "mav0/*" of "mav0/*/*.csv" for a folder of two parts; empty where the pattern means nothing below such a
/// folder.
std::string beginning_of(const std::string& pattern, std::size_t parts) {
  std::size_t end = 0;
  for (std::size_t i = 0; i < parts; ++i) {
    end = pattern.find('/', end + (i == 0 ? 0 : 1));
    if (end == std::string::npos) return "";
  }
  return pattern.substr(0, end);
}

/// Adds what lies in `folder / below`. Goes into no folder that the patterns do not name: it may be
/// somebody's home.
void add_files(const fs::path& folder, const fs::path& below, const std::vector<std::string>& patterns,
               std::vector<fs::path>& files) {
  std::error_code error;
  fs::directory_iterator entry(folder / below, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const fs::path file = below / entry->path().filename();
    std::error_code ignored;
    if (!fs::is_directory(entry->symlink_status(ignored))) {
      if (matches(file, patterns)) files.push_back(file);
      continue;
    }
    const auto parts = static_cast<std::size_t>(std::distance(file.begin(), file.end()));
    const auto leads_there = [&](const std::string& pattern) {
      const std::string beginning = beginning_of(pattern, parts);
      return !beginning.empty() && fnmatch(beginning.c_str(), file.c_str(), FNM_PATHNAME) == 0;
    };
    if (std::ranges::any_of(patterns, leads_there)) add_files(folder, file, patterns, files);
  }
  // A file that cannot be looked at may be the user's own.
  const bool is_none = error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory;
  if (error && !is_none) refuse_output(folder / below, error.value());
}

}  // namespace

std::vector<fs::path> files_of(const fs::path& folder, const std::vector<std::string>& patterns) {
  std::vector<fs::path> files;
  add_files(folder, "", patterns, files);
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
  fs::directory_iterator entry(folder, ignored);
  for (; !ignored && entry != fs::directory_iterator(); entry.increment(ignored))
    if (is_unfinished_name(entry->path()) && is_left_over(entry->path())) left.push_back(entry->path());
  for (const fs::path& path : left) remove_unfinished(path);
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
    read_list();
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
    throw ScenarioError(fmt::format("{}: understory did not write this file: move it away", file.string()));
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

void FolderClaim::read_list() {
  std::string text;
  char piece[65536];
  for (ssize_t count; (count = pread(file_, piece, sizeof piece, static_cast<off_t>(text.size()))) > 0;)
    text.append(piece, static_cast<std::size_t>(count));
  if (header.starts_with(text)) {  // new, or torn by a power cut
    append(std::string(header.substr(text.size())));
    return;
  }
  if (!text.starts_with(header)) {
    is_new_ = false;
    throw ScenarioError(
        fmt::format("{}: understory did not write this file: move it away", (folder_ / claim_name).string()));
  }
  std::size_t begin = header.size();
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string line = text.substr(begin, end - begin);
    const std::size_t blank = line.find(' ');
    if (blank == std::string::npos) continue;
    const std::string kind = line.substr(0, blank), file = line.substr(blank + 1);
    const fs::path path = file;
    const bool lies_within = path.is_relative() && std::ranges::find(path, "..") == path.end();
    if (kind == gone)
      written_.erase(file);
    else if (lies_within)
      written_[file] = kind;
  }
  is_listed_ = !written_.empty();
  if (begin < text.size()) append("\n");  // torn by a power cut
}

void FolderClaim::append(const std::string& lines) {
  if (write(file_, lines.data(), lines.size()) != static_cast<ssize_t>(lines.size()))
    refuse_output(folder_ / claim_name, errno);
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
  const bool is_empty = !is_listed_;
  if (file_ >= 0 && is_new_ && is_locked_ && is_empty && is_file(file_, file)) ::unlink(file.c_str());
  if (file_ >= 0) close(file_);
  file_ = -1;
  if (!is_empty) return;
  for (auto made = made_.rbegin(); made != made_.rend(); ++made) ::rmdir(made->c_str());  // where it is empty
}

bool FolderClaim::holds_other_files() const {
  std::error_code error, ignored;
  fs::recursive_directory_iterator entry(folder_, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const std::string file = entry->path().lexically_relative(folder_).string();
    const bool is_ours = file == claim_name || owns(entry->path()) || is_unfinished_file_name(entry->path());
    if (!is_ours && !fs::is_directory(entry->symlink_status(ignored))) return true;
  }
  return static_cast<bool>(error);  // what cannot be looked at is somebody's
}

bool FolderClaim::owns(const fs::path& file) const {
  const std::string relative = file.lexically_relative(folder_).string();
  const auto found = written_.find(relative);
  return (found != written_.end() && found->second == kind_) || adopted_.contains(relative);
}

void FolderClaim::adopt(const std::vector<std::string>& patterns) {
  if (!written_.empty()) return;
  for (const fs::path& file : files_of(folder_, patterns)) adopted_.insert(file.string());
}

void FolderClaim::require_own(const std::vector<std::string>& patterns) {
  std::error_code ignored;
  for (const std::string& pattern : patterns) {
    const fs::path within = folder_ / folder_in(pattern);
    const fs::file_status status = fs::symlink_status(within, ignored);
    if (!folder_in(pattern).empty() && fs::is_symlink(status))  // its files are not in this folder
      throw ScenarioError(fmt::format("{}: must be a folder, is a link", within.string()));
    if (!folder_in(pattern).empty() && fs::exists(status) && !fs::is_directory(status))
      refuse_output(within, ENOTDIR);
    if (pattern.find('*') == std::string::npos && fs::is_directory(folder_ / pattern, ignored))
      refuse_output(folder_ / pattern, EISDIR);
  }
  for (const fs::path& file : files_of(folder_, patterns)) require_own(folder_ / file);
}

void FolderClaim::require_own(const fs::path& file) {
  std::error_code ignored;
  if (owns(file) || !fs::exists(fs::symlink_status(file, ignored))) return;
  const auto hold = hold_outputs();
  read_list();  // whoever writes beside us may have added it
  if (owns(file)) return;
  throw ScenarioError(fmt::format(
      "{}: is there and is no {} of understory's: move it away, or name another folder with --out",
      file.string(), kind_));
}

bool FolderClaim::resumes(const char* manifest, const std::vector<std::string>& patterns,
                          const fs::path& name, bool force) {
  std::error_code ignored;
  const bool is_there = fs::exists(folder_ / manifest, ignored);
  if (is_there) {
    adopt(patterns);
  } else if (!force && holds_other_files()) {
    throw ScenarioError(
        fmt::format("{}: holds other files and no {}: --out names another folder, --force "
                    "writes beside them",
                    name.string(), kind_));
  }
  require_own(patterns);
  return is_there;
}

void FolderClaim::add(const std::vector<fs::path>& files) {
  const auto hold = hold_outputs();
  for (const fs::path& file : files) require_own(file);
  std::string lines;
  for (const std::string& file : adopted_) lines += fmt::format("{} {}\n", kind_, file);
  for (const fs::path& file : files) {
    const std::string relative = file.lexically_relative(folder_).string();
    added_.insert(relative);
    const auto known = written_.find(relative);
    const bool is_new = known == written_.end() || known->second != kind_;
    if (is_new && !adopted_.contains(relative)) lines += fmt::format("{} {}\n", kind_, relative);
    written_[relative] = kind_;
  }
  for (const std::string& file : adopted_) written_[file] = kind_;
  adopted_.clear();
  if (lines.empty()) return;
  append(lines);
  is_listed_ = true;
  fdatasync(file_);  // whoever finds a file after a power cut must find whose it is
}

void FolderClaim::remove_stale(const std::vector<std::string>& patterns) {
  const auto hold = hold_outputs();
  std::error_code ignored;
  std::set<fs::path> folders;
  std::string lines;
  for (auto file = written_.begin(); file != written_.end();) {
    const bool is_stale =
        file->second == kind_ && !added_.contains(file->first) && matches(file->first, patterns);
    if (is_stale) {
      fs::remove(folder_ / file->first, ignored);
      folders.insert((folder_ / file->first).parent_path());
      lines += fmt::format("{} {}\n", gone, file->first);
    }
    file = is_stale ? written_.erase(file) : std::next(file);
  }
  for (const fs::path& folder : folders)
    if (folder != folder_) ::rmdir(folder.c_str());  // where it is empty
  if (lines.empty()) return;
  append(lines);
  fdatasync(file_);
}

void FolderClaim::made_folders(const std::vector<fs::path>& folders) {
  const auto hold = hold_outputs();
  made_.insert(made_.end(), folders.begin(), folders.end());
}

}  // namespace understory
