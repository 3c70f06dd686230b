// Preloaded (LD_PRELOAD): a disk that fills up, and a diary of what reached it. For the tests of a program
// that cannot mount one.
//   FAILING_DISK_FOLDER   files below it are on the disk
//   FAILING_DISK_BYTES    so many may be written to them, then ENOSPC; absent: any number
//   FAILING_DISK_DIARY    gets a line for each "write PATH", "sync PATH", "syncfs", "rename FROM TO", "say"
//   (descriptor 1)
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
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

}  // namespace

extern "C" {

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
  return next<int (*)(const char*, const char*)>("rename")(from, to);
}
}
