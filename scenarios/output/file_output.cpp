#include "scenarios/output/file_output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fnmatch.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>

#include "perception/io/machine_limits.hpp"
#include "scenarios/output/folder_mark.hpp"
#include "scenarios/output/signals.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// Where a name leads, symbolic links followed.
struct Destination {
  fs::path file;
  int descriptor = -1;     ///< of this process, where the name means one of them: /dev/stdout
  bool is_stream = false;  ///< a device or a FIFO: neither replaced nor removed
};

Destination destination_of(const fs::path& given) {
  std::error_code error;
  const fs::path descriptors = fs::canonical("/proc/self/fd", error);
  fs::path name = given;
  for (int links = 0; links < 40; ++links) {
    const fs::path folder = fs::canonical(name.has_parent_path() ? name.parent_path() : ".", error);
    if (error) refuse_output(given, error.value());
    const std::string last = name.filename().string();
    int descriptor = -1;
    if (folder == descriptors &&
        std::from_chars(last.data(), last.data() + last.size(), descriptor).ec == std::errc())
      return {given, descriptor, true};
    const fs::path file = folder / last;
    const fs::file_status status = fs::symlink_status(file, error);
    if (error && error != std::errc::no_such_file_or_directory) refuse_output(given, error.value());
    if (!fs::is_symlink(status)) {
      if (fs::is_directory(status)) refuse_output(given, EISDIR);
      return {file, -1, fs::exists(status) && !fs::is_regular_file(status)};
    }
    name = folder / fs::read_symlink(file, error);
    if (error) refuse_output(given, error.value());
  }
  refuse_output(given, ELOOP);
}

/// An open file, closed with the last word on whether all was written.
class Stream {
 public:
  explicit Stream(int descriptor) : descriptor_(descriptor) {}
  ~Stream() { close(); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// errno of what failed, 0 where nothing did.
  int write(std::string_view content) {
    if (descriptor_ < 0) return errno;
    struct sigaction ignore {
    }, before{};
    ignore.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &ignore, &before);  // a reader that is gone is an error like others
    int error = 0;
    while (!content.empty() && error == 0) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written >= 0)
        content.remove_prefix(static_cast<std::size_t>(written));
      else if (errno != EINTR)
        error = errno;
    }
    sigaction(SIGPIPE, &before, nullptr);
    return error;
  }
  bool is_open() const { return descriptor_ >= 0; }
  int sync() { return fsync(descriptor_) == 0 ? 0 : errno; }
  int close() {
    const int error = descriptor_ >= 0 && ::close(descriptor_) != 0 ? errno : 0;
    descriptor_ = -1;
    return error;
  }

 private:
  int descriptor_;
};

/// A new file, locked while it is open: what bears such a name and is not locked was left by a killed
/// program.
int made(const fs::path& part) {
  const auto lock = hold_outputs();
  // The name is this process's own: what bears it was left by another one of the same number.
  std::remove(part.c_str());
  for (;;) {
    const int descriptor = open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) return descriptor;
    const bool is_taken = flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    struct stat status {};
    if (!is_taken && fstat(descriptor, &status) == 0 && status.st_nlink > 0) return descriptor;
    close(descriptor);  // another program cleared it away before it was locked
    std::remove(part.c_str());
  }
}

/// That a file can be made in `folder` and gets a first block.
void probe(const fs::path& name, const fs::path& folder) {
  const Unfinished part(unfinished_name_in(folder));
  const int error = Stream(made(part.path())).write(std::string(4096, ' '));
  if (error != 0) refuse_output(name, error);
}

constexpr std::string_view unfinished_prefix = ".understory-", unfinished_suffix = ".unfinished";

std::string host_name() {
  char host[64] = "";
  gethostname(host, sizeof host - 1);
  return host;
}

bool lies_in_unfinished_folder(const fs::path& file) {
  return std::ranges::any_of(file.parent_path(), is_unfinished_name);
}

}  // namespace

bool is_unfinished_name(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with(unfinished_prefix) && name.ends_with(unfinished_suffix);
}

bool is_unfinished_file_name(const fs::path& path) {
  return fnmatch(".understory-*-[0-9]*-[0-9]*.unfinished", path.filename().c_str(), 0) == 0;
}

fs::path unfinished_name_in(const fs::path& folder) {
  static std::atomic<int> count = 0;
  // Programs on two machines may write into one folder.
  const std::string owner = fmt::format("{}-{}-{}", host_name(), getpid(), count++);
  return folder / fmt::format("{}{}{}", unfinished_prefix, owner, unfinished_suffix);
}

fs::path unfinished_name_of(const fs::path& target, const fs::path& folder) {
  return folder / fmt::format("{}{}{}", unfinished_prefix, target.filename().string(), unfinished_suffix);
}

void refuse_output(const fs::path& file, int error) {
  if (const std::string lacking = lacking_resource(error); !lacking.empty())
    throw MachineError(fmt::format("{}: {}", file.string(), lacking));
  if (error == ENOSPC || error == EDQUOT || error == EIO || error == EPIPE)
    throw MachineError(fmt::format("{}: {}", file.string(), std::strerror(error)));
  throw ScenarioError(fmt::format("{}: cannot write here: {}", file.string(), std::strerror(error)));
}

struct OutputFile::State {
  fs::path name;
  Destination to;
  FolderMark* mark = nullptr;
  std::optional<Unfinished> part;
  std::optional<Stream> stream;
};

OutputFile::OutputFile(fs::path file, FolderMark* mark) : state_(std::make_unique<State>()) {
  State& state = *state_;
  state.name = std::move(file);
  state.mark = mark;
  state.to = destination_of(state.name);
  if (state.to.is_stream) {
    std::fflush(stdout);  // what was printed before stands before
    state.stream.emplace(state.to.descriptor >= 0
                             ? fcntl(state.to.descriptor, F_DUPFD_CLOEXEC, 0)
                             : open(state.to.file.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
  } else {
    if (mark != nullptr) mark->require_own(state.to.file.filename());
    state.part.emplace(unfinished_name_in(state.to.file.parent_path()));
    state.stream.emplace(made(state.part->path()));
  }
  if (!state.stream->is_open()) refuse_output(state.name, errno);
}

OutputFile::~OutputFile() = default;

void OutputFile::write(std::string_view bytes) {
  if (const int error = state_->stream->write(bytes); error != 0) refuse_output(state_->name, error);
}

void OutputFile::finish() {
  State& state = *state_;
  const fs::path& file = state.to.file;
  const bool lasts = !state.to.is_stream && !lies_in_unfinished_folder(file);
  struct stat former {};
  int error = 0;
  if (state.part && stat(file.c_str(), &former) == 0)
    chmod(state.part->path().c_str(), former.st_mode & 07777);
  if (lasts) error = state.stream->sync();
  // Named before it is closed: until then its lock says that somebody is at work on it.
  if (error == 0 && state.mark != nullptr) state.mark->add({file.filename()});
  if (error == 0 && state.part) state.part->rename_to(file);
  if (const int last = state.stream->close(); error == 0) error = last;
  if (error != 0) refuse_output(state.name, error);
  if (lasts) sync_folder(file.parent_path());  // the new name is the folder's
}

void write_whole_file(const fs::path& file, std::string_view content, FolderMark* mark) {
  OutputFile output(file, mark);
  output.write(content);
  output.finish();
}

void sync_folder(const fs::path& folder) {
  Stream stream(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  const int error = stream.is_open() ? stream.sync() : errno;
  if (error != 0 && error != EINVAL)
    refuse_output(folder, error);  // EINVAL: its file system knows no such thing
}

void sync_file_system(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const int error = descriptor < 0 || syncfs(descriptor) != 0 ? errno : 0;
  if (descriptor >= 0) close(descriptor);
  if (error != 0) refuse_output(folder, error);
}

bool is_stream(const fs::path& file) { return destination_of(file).is_stream; }

void require_writable(const fs::path& file) {
  if (file.empty()) return;
  const Destination to = destination_of(file);
  if (to.descriptor >= 0) {
    const int flags = fcntl(to.descriptor, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) refuse_output(file, EBADF);
    return;
  }
  std::error_code ignored;
  if (fs::exists(to.file, ignored) && access(to.file.c_str(), W_OK) != 0) refuse_output(file, errno);
  if (to.is_stream) return;
  clear_unfinished(to.file.parent_path());
  probe(file, to.file.parent_path());
}

void prepare_output_folder(const fs::path& folder) {
  make_folders(folder, folder);
  clear_unfinished(folder);
  probe(folder, folder);
}

fs::path path_within(const fs::path& path, const fs::path& folder) {
  if (path.empty() || folder.empty()) return {};
  std::error_code ignored;
  const fs::path whole = fs::weakly_canonical(fs::absolute(path), ignored);
  const fs::path whole_folder = fs::weakly_canonical(fs::absolute(folder), ignored);
  if (whole.empty() || whole_folder.empty()) return {};
  const fs::path relative = whole.lexically_relative(whole_folder);
  return relative.empty() || *relative.begin() == ".." ? fs::path() : relative;
}

void refuse_other_use(const fs::path& output, const char* use) {
  throw ScenarioError(fmt::format("{}: expected an output of its own, {}", output.string(), use));
}

std::optional<std::string> find_below(const fs::path& folder,
                                      const std::function<bool(const std::string&)>& is_wanted) {
  std::error_code error, ignored;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const fs::path& path = entry->path();
    if (fs::is_directory(entry->symlink_status(ignored))) {
      if (fs::exists(path / mark_name, ignored)) entry.disable_recursion_pending();
    } else if (path != folder / mark_name && !is_unfinished_file_name(path)) {
      const std::string file = path.lexically_relative(folder).string();
      if (is_wanted(file)) return file;
    }
  }
  if (error) refuse_output(folder, error.value());
  return {};
}

std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> files;
  find_below(folder, [&](const std::string& file) {
    files.push_back(file);
    return false;
  });
  std::ranges::sort(files);
  return files;
}

void require_separate(const std::vector<fs::path>& outputs, const std::vector<fs::path>& others) {
  const auto same = [](const fs::path& one, const fs::path& other) {
    std::error_code ignored;
    if (one.empty() || other.empty() ||
        (fs::exists(one, ignored) && !fs::is_directory(one, ignored) && is_stream(one)))
      return false;
    const fs::path whole = fs::weakly_canonical(fs::absolute(one), ignored);  // empty where it cannot be told
    return fs::equivalent(one, other, ignored) ||
           (!whole.empty() && whole == fs::weakly_canonical(fs::absolute(other), ignored));
  };
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (const fs::path& other : others)
      if (same(outputs[i], other))
        refuse_other_use(outputs[i], "this file or folder is read, or holds another result");
    for (std::size_t j = 0; j < i; ++j)
      if (same(outputs[i], outputs[j])) refuse_other_use(outputs[i], "it is given twice");
  }
}

void require_not_within(const fs::path& folder, const std::vector<fs::path>& others) {
  for (const fs::path& other : others)
    if (!path_within(folder, other).empty()) refuse_other_use(folder, "this folder lies within what is read");
}

std::optional<std::string> unpacked(std::string_view packed, std::size_t maximum_bytes) {
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > maximum_bytes)
    return std::nullopt;
  std::string plain(size, '\0');
  if (ZSTD_isError(ZSTD_decompress(plain.data(), plain.size(), packed.data(), packed.size())))
    return std::nullopt;
  return plain;
}

}  // namespace understory
