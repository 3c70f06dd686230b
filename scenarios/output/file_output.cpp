#include "scenarios/output/file_output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fnmatch.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>

#include "scenarios/output/folder_claim.hpp"
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
  const int descriptor = open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor >= 0) flock(descriptor, LOCK_EX | LOCK_NB);
  return descriptor;
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

/// Also of a process that has ended and that nobody waits for (a zombie): it has no program.
bool is_gone(int process) {
  char program = 0;
  return readlink(fmt::format("/proc/{}/exe", process).c_str(), &program, 1) < 0 && errno == ENOENT;
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

bool is_at_work_on(const fs::path& unfinished) {
  const std::string name = unfinished.filename().string(),
                    ours = fmt::format("{}{}-", unfinished_prefix, host_name());
  int process = 0;
  if (!name.starts_with(ours)) return false;
  const auto parsed = std::from_chars(name.data() + ours.size(), name.data() + name.size(), process);
  return parsed.ec == std::errc() && *parsed.ptr == '-' && process != getpid() && !is_gone(process);
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
  FolderClaim* claim = nullptr;  ///< which lists the file, where it is not the user's to name
  std::optional<Unfinished> part;
  std::optional<Stream> stream;
};

OutputFile::OutputFile(fs::path file, Named named) : state_(std::make_unique<State>()) {
  State& state = *state_;
  state.name = std::move(file);
  state.to = destination_of(state.name);
  if (state.to.is_stream) {
    std::fflush(stdout);  // what was printed before stands before
    state.stream.emplace(state.to.descriptor >= 0
                             ? fcntl(state.to.descriptor, F_DUPFD_CLOEXEC, 0)
                             : open(state.to.file.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
  } else {
    const bool asks = named == Named::by_us && !lies_in_unfinished_folder(state.to.file);
    state.claim = asks ? claim_of(state.to.file) : nullptr;
    if (state.claim != nullptr) state.claim->require_own(state.to.file);
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
  if (error == 0 && state.claim != nullptr) state.claim->add({file});
  // Named before it is closed: until then its lock says that somebody is at work on it.
  if (error == 0 && state.part) state.part->become(file);
  if (const int last = state.stream->close(); error == 0) error = last;
  if (error != 0) refuse_output(state.name, error);
  if (lasts) sync_folder(file.parent_path());  // the new name is the folder's
}

void write_whole_file(const fs::path& file, std::string_view content, Named named) {
  OutputFile output(file, named);
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
  const std::vector<fs::path> made = make_folders(folder, folder);
  std::error_code ignored;
  if (FolderClaim* claim = claim_of(fs::weakly_canonical(folder, ignored))) claim->made_folders(made);
  clear_unfinished(folder);
  probe(folder, folder);
}

namespace {

/// `path` below `folder`; empty where it is not.
fs::path path_within(const fs::path& path, const fs::path& folder) {
  std::error_code ignored;
  const fs::path whole = fs::weakly_canonical(fs::absolute(path), ignored);
  const fs::path whole_folder = fs::weakly_canonical(fs::absolute(folder), ignored);
  if (whole.empty() || whole_folder.empty()) return {};
  const fs::path relative = whole.lexically_relative(whole_folder);
  return relative.empty() || *relative.begin() == ".." ? fs::path() : relative;
}

[[noreturn]] void refuse_other_use(const fs::path& output, const char* use) {
  throw ScenarioError(fmt::format("{}: expected an output of its own, {}", output.string(), use));
}

}  // namespace

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

void require_outside(const std::vector<fs::path>& outputs, const fs::path& folder,
                     const std::vector<std::string>& patterns) {
  for (const fs::path& output : outputs) {
    const fs::path within = output.empty() ? fs::path() : path_within(output, folder);
    if (!within.empty() && matches(within, patterns))
      refuse_other_use(output, "results are read or written there");
  }
}

void require_not_within(const fs::path& folder, const std::vector<fs::path>& others) {
  for (const fs::path& other : others)
    if (!path_within(folder, other).empty()) refuse_other_use(folder, "this folder lies within what is read");
}

}  // namespace understory
