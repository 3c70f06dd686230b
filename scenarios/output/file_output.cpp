#include "scenarios/output/file_output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>

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
  int sync() { return fsync(descriptor_) == 0 ? 0 : errno; }
  int close() {
    const int error = descriptor_ >= 0 && ::close(descriptor_) != 0 ? errno : 0;
    descriptor_ = -1;
    return error;
  }

 private:
  int descriptor_;
};

void write_through(const fs::path& name, const Destination& to, std::string_view content) {
  std::fflush(stdout);  // what was printed before stands before
  Stream stream(to.descriptor >= 0 ? fcntl(to.descriptor, F_DUPFD_CLOEXEC, 0)
                                   : open(to.file.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
  int error = stream.write(content);
  if (const int last = stream.close(); error == 0) error = last;
  if (error != 0) refuse_output(name, error);
}

/// Two programs may write one file at a time, even from two machines: each has a part of its own.
fs::path part_of(const fs::path& file) {
  char host[64] = "";
  gethostname(host, sizeof host - 1);
  return fmt::format("{}.{}-{}.part", file.string(), host, getpid());
}

int made(const fs::path& part) {
  const auto lock = hold_outputs();
  std::remove(part.c_str());
  return open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

void write_regular(const fs::path& name, const fs::path& file, std::string_view content, bool lasting) {
  Unfinished part(part_of(file));
  Stream stream(made(part.path()));
  int error = stream.write(content);
  struct stat former {};
  if (error == 0 && stat(file.c_str(), &former) == 0) chmod(part.path().c_str(), former.st_mode & 07777);
  if (error == 0 && lasting) error = stream.sync();
  if (const int last = stream.close(); error == 0) error = last;
  if (error != 0) refuse_output(name, error);
  part.become(file);
  if (!lasting) return;
  // The new name is the folder's, and lasts once that has reached the disk.
  Stream(open(file.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)).sync();
}

void write(const fs::path& name, std::string_view content, bool lasting) {
  const Destination to = destination_of(name);
  if (to.is_stream)
    write_through(name, to, content);
  else
    write_regular(name, to.file, content, lasting);
}

/// That a file can be made beside `file` and gets a first block.
void probe(const fs::path& name, const fs::path& file) {
  const Unfinished part(part_of(file));
  const int error = Stream(made(part.path())).write(std::string(4096, ' '));
  if (error != 0) refuse_output(name, error);
}

}  // namespace

void refuse_output(const fs::path& file, int error) {
  if (error == ENOSPC || error == EDQUOT || error == EIO || error == EPIPE)
    throw MachineError(fmt::format("{}: {}", file.string(), std::strerror(error)));
  throw ScenarioError(fmt::format("{}: expected a writable output: {}", file.string(), std::strerror(error)));
}

void write_whole_file(const fs::path& file, std::string_view content) { write(file, content, false); }

void write_lasting_file(const fs::path& file, std::string_view content) { write(file, content, true); }

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
  if (!to.is_stream) probe(file, to.file);
}

void prepare_output_folder(const fs::path& folder) {
  std::error_code error;
  {
    const auto lock = hold_outputs();
    fs::create_directories(folder, error);
  }
  if (error) refuse_output(folder, error.value());
  if (!fs::is_directory(folder)) refuse_output(folder, ENOTDIR);
  probe(folder, folder / "probe");
}

void require_free_space(const fs::path& file, std::uintmax_t bytes) {
  std::error_code error;
  const fs::space_info space = fs::space(file.parent_path(), error);
  if (!error && space.available < bytes) refuse_output(file, ENOSPC);
}

}  // namespace understory
