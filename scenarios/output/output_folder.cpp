#include "scenarios/output/output_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fnmatch.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

constexpr const char* lock_name = "lock";

/// Every file below `folder` that a pattern means, by relative path; `parts` that are being written left out.
std::vector<fs::path> files_of(const fs::path& folder, const std::vector<std::string>& patterns) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (auto entry = fs::recursive_directory_iterator(folder, ignored);
       entry != fs::recursive_directory_iterator(); entry.increment(ignored)) {
    const fs::path file = entry->path().lexically_relative(folder);
    const auto means = [&](const std::string& pattern) {
      return fnmatch(pattern.c_str(), file.c_str(), FNM_PATHNAME) == 0;
    };
    if (!entry->is_directory(ignored) && std::ranges::any_of(patterns, means)) files.push_back(file);
  }
  return files;
}

void refuse_to_replace(const fs::path& folder, const fs::path& given, const FolderContents& contents,
                       Replace replace) {
  const std::vector<fs::path> held = files_of(folder, contents.patterns);
  if (held.empty()) return;
  const auto refuse = [&](const std::string& what) {
    throw ScenarioError(fmt::format("{}: {}", given.string(), what));
  };
  if (!fs::exists(folder / contents.manifest))
    refuse(fmt::format("holds {}, and no {} that says whose it is: expected another folder",
                       held.front().string(), contents.manifest));
  if (replace == Replace::nothing)
    refuse("holds results already: --force replaces them, --out names another folder");
  if (replace == Replace::same &&
      read_file(folder / contents.manifest, maximum_json_bytes) != contents.manifest_text)
    refuse(fmt::format(
        "holds results of another configuration ({}): --force replaces them, --out names another folder",
        contents.manifest));
}

/// Beside the folder, so that it gets its name at once. Within it where it lies on a disk of its own, or
/// where nothing can be made beside it.
fs::path part_of(const fs::path& folder) {
  const fs::path parent = folder.parent_path();
  struct stat here {
  }, above{};
  const bool exists = stat(folder.c_str(), &here) == 0;
  stat(parent.c_str(), &above);
  if (exists && (here.st_dev != above.st_dev || access(parent.c_str(), W_OK) != 0))
    return folder / "unfinished.part";
  return fs::path(folder) += ".part";
}

/// With every symbolic link followed, so that the links stay.
fs::path resolved(const fs::path& folder) {
  std::error_code error;
  fs::path path = fs::weakly_canonical(fs::absolute(folder), error);
  for (int links = 0; !error && fs::is_symlink(path) && links < 40; ++links)  // one that leads to nothing yet
    path = fs::weakly_canonical(path.parent_path() / fs::read_symlink(path), error);
  if (error) refuse_output(folder, error.value());
  return path.has_filename() ? path : path.parent_path();
}

/// What a program left that was killed: its lock says that it is of this make.
void empty(const fs::path& part) {
  for (const auto& entry : fs::directory_iterator(part))
    if (entry.path().filename() != lock_name) fs::remove_all(entry.path());
}

void require_own(const fs::path& part) {
  std::error_code ignored;
  if (!fs::exists(part, ignored) || fs::exists(part / lock_name, ignored) || fs::is_empty(part, ignored))
    return;
  throw ScenarioError(
      fmt::format("{}: expected nothing there, or what a killed understory left", part.string()));
}

/// Whether the open file still bears that name.
bool is_file(int descriptor, const fs::path& name) {
  struct stat held {
  }, there{};
  return fstat(descriptor, &held) == 0 && stat(name.c_str(), &there) == 0 && held.st_ino == there.st_ino;
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder, const fs::path& name) : folder_(folder) {
  const fs::path file = folder / lock_name;
  while (true) {
    std::error_code error;
    is_new_ = fs::create_directories(folder, error) || is_new_;
    if (error) refuse_output(name, error.value());
    file_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0 && errno == ENOENT) continue;  // the folder got its name meanwhile
    if (file_ < 0) refuse_output(name, errno);
    if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
      close(file_);
      throw ScenarioError(fmt::format("{}: another understory writes there at this moment", name.string()));
    }
    if (is_file(file_, file)) {
      file_name_.emplace(file);
      return;
    }
    close(file_);
  }
}

FolderLock::~FolderLock() {
  if (!is_file(file_, file_name_->path())) file_name_->keep();  // another's: the folder has got its name
  file_name_.reset();
  if (is_new_) ::rmdir(folder_.c_str());  // where it is empty
  close(file_);
}

OutputFolder::OutputFolder(fs::path folder, FolderContents contents, Replace replace)
    : folder_(resolved(folder)), contents_(std::move(contents)) {
  std::error_code ignored;
  if (fs::exists(folder_, ignored) && !fs::is_directory(folder_, ignored)) refuse_output(folder, ENOTDIR);
  const fs::path part = part_of(folder_);
  require_own(part);
  {
    const auto lock = hold_outputs();
    lock_.emplace(part, folder);
    part_.emplace(part);
    empty(part);
  }
  refuse_to_replace(folder_, folder, contents_, replace);
  write_whole_file(part / contents_.manifest, contents_.manifest_text);
}

void OutputFolder::finish() {
  const auto lock = hold_outputs();  // no signal comes between
  const fs::path part = path();
  if (part.parent_path() != folder_) {
    if (std::rename(part.c_str(), folder_.c_str()) == 0) {  // new, or empty
      part_->keep();
      fs::remove(folder_ / lock_name);
      return;
    }
    if (errno != ENOTEMPTY && errno != EEXIST) refuse_output(folder_, errno);
  }
  const fs::path mark = contents_.patterns.front();
  fs::remove(folder_ / mark);
  for (const fs::path& former : files_of(folder_, contents_.patterns)) fs::remove(folder_ / former);
  std::vector<fs::path> written = files_of(part, contents_.patterns);
  std::ranges::partition(written, [&](const fs::path& file) { return file != mark; });
  for (const fs::path& file : written) {
    fs::create_directories((folder_ / file).parent_path());
    fs::rename(part / file, folder_ / file);
  }
}

}  // namespace understory
