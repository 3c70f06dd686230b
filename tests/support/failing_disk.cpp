// Preloaded (LD_PRELOAD): a disk that fills up, and a diary of what reached it. For the tests of a program
// that cannot mount one.
//   FAILING_DISK_FOLDER   files below it are on the disk
//   FAILING_DISK_BYTES    so many may be written to them, then ENOSPC; absent: any number
//   FAILING_DISK_DIARY    gets a line for each "write PATH", "sync PATH", "syncfs", "rename FROM TO", "say"
//   (descriptor 1)
//   FAILING_DISK_KILL     the program and whoever of its children gets there are killed at this moment:
//                         before (odd) or behind (even) a call that makes, changes or removes a name on the
//                         disk
//   FAILING_DISK_CALLS    a file of 16 bytes, zero at first, in which they count these moments
//   FAILING_DISK_SIGNALS  "-1.txt 11 -3.txt 9": who makes a file whose name ends so is sent that signal first
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>

namespace {

std::atomic<long long> written = 0;

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

std::string path_of(int descriptor) {
  char link[64], path[4096];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, sizeof path);
  return length > 0 ? std::string(path, static_cast<std::size_t>(length)) : "";
}

bool is_on_disk(const std::string& path) {
  const char* folder = std::getenv("FAILING_DISK_FOLDER");
  return folder != nullptr && path.rfind(folder, 0) == 0;
}

void note(const std::string& line) {
  const char* diary = std::getenv("FAILING_DISK_DIARY");
  if (diary == nullptr) return;
  const int file = open(diary, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  const std::string whole = line + "\n";
  static const auto write_it = next<ssize_t (*)(int, const void*, size_t)>("write");
  if (write_it(file, whole.data(), whole.size()) < 0) std::abort();
  close(file);
}

/// False where the disk is full.
bool takes(int descriptor, std::size_t bytes) {
  const std::string path = path_of(descriptor);
  if (descriptor == 1) note("say");
  if (!is_on_disk(path)) return true;
  const char* limit = std::getenv("FAILING_DISK_BYTES");
  if (limit != nullptr && written + static_cast<long long>(bytes) > std::atoll(limit)) {
    errno = ENOSPC;
    return false;
  }
  written += static_cast<long long>(bytes);
  note("write " + path);
  return true;
}

/// Counts a moment, and kills there: the first process of all too, so that nobody goes on.
void moment(const std::string& path) {
  static auto* const counts = [] {
    const char* name = std::getenv("FAILING_DISK_CALLS");
    const int file =
        name == nullptr ? -1 : next<int (*)(const char*, int, ...)>("open")(name, O_RDWR | O_CLOEXEC);
    void* shared = mmap(nullptr, 16, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    return file < 0 || shared == MAP_FAILED ? nullptr : static_cast<std::atomic<long long>*>(shared);
  }();
  if (counts == nullptr || !is_on_disk(path)) return;
  long long nobody = 0;
  counts[1].compare_exchange_strong(nobody, getpid());
  const char* last = std::getenv("FAILING_DISK_KILL");
  if (++counts[0] != (last == nullptr ? -1 : std::atoll(last))) return;
  kill(static_cast<pid_t>(counts[1]), SIGKILL);
  raise(SIGKILL);
}

/// A path as the call means it.
std::string path_at(int folder, const char* path) {
  return folder == AT_FDCWD || path[0] == '/' ? path : path_of(folder) + "/" + path;
}

template <typename... Arguments>
int at_moments(const char* call, const std::string& path, Arguments... arguments) {
  moment(path);
  const int result = next<int (*)(Arguments...)>(call)(arguments...);
  const int error = errno;
  moment(path);
  errno = error;
  return result;
}

/// Sends this process the signal that FAILING_DISK_SIGNALS has for a file of that name.
void strike(const std::string& path) {
  const char* list = std::getenv("FAILING_DISK_SIGNALS");
  std::istringstream words(list == nullptr ? "" : list);
  int signal = 0;
  for (std::string end; words >> end >> signal;)
    if (path.ends_with(end)) raise(signal);
}

int open_file(const char* path, int flags, unsigned mode) {
  static const auto original = next<int (*)(const char*, int, ...)>("open");
  const bool makes = (flags & O_CREAT) != 0;
  if (makes) strike(path), moment(path);
  const int descriptor = original(path, flags, mode), error = errno;
  if (makes) moment(path);
  errno = error;
  return descriptor;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const unsigned mode = (flags & O_CREAT) != 0 ? va_arg(rest, unsigned) : 0;
  va_end(rest);
  return open_file(path, flags, mode);
}
int mkdir(const char* path, mode_t mode) noexcept { return at_moments("mkdir", path, path, mode); }
int rmdir(const char* path) noexcept { return at_moments("rmdir", path, path); }
int unlink(const char* path) noexcept { return at_moments("unlink", path, path); }
int remove(const char* path) noexcept { return at_moments("remove", path, path); }
int link(const char* from, const char* to) noexcept { return at_moments("link", to, from, to); }
int symlink(const char* from, const char* to) noexcept { return at_moments("symlink", to, from, to); }
int unlinkat(int folder, const char* path, int flags) noexcept {
  return at_moments("unlinkat", path_at(folder, path), folder, path, flags);
}

ssize_t write(int descriptor, const void* data, size_t size) {
  static const auto original = next<ssize_t (*)(int, const void*, size_t)>("write");
  return takes(descriptor, size) ? original(descriptor, data, size) : -1;
}

ssize_t writev(int descriptor, const iovec* pieces, int count) {
  static const auto original = next<ssize_t (*)(int, const iovec*, int)>("writev");
  std::size_t size = 0;
  for (int i = 0; i < count; ++i) size += pieces[i].iov_len;
  return takes(descriptor, size) ? original(descriptor, pieces, count) : -1;
}

int fsync(int descriptor) {
  note("sync " + path_of(descriptor));
  return next<int (*)(int)>("fsync")(descriptor);
}

int fdatasync(int descriptor) {
  note("sync " + path_of(descriptor));
  return next<int (*)(int)>("fdatasync")(descriptor);
}

int syncfs(int descriptor) noexcept {
  note("syncfs");
  return next<int (*)(int)>("syncfs")(descriptor);
}

int rename(const char* from, const char* to) noexcept {
  note(std::string("rename ") + from + " " + to);
  return at_moments("rename", to, from, to);
}
}
