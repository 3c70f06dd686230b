#include "perception/io/machine_limits.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>

#include "perception/io/text_file.hpp"

namespace understory {

std::string lacking_resource(int error) {
  const auto limit = [](auto kind) {
    struct rlimit is {};
    getrlimit(kind, &is);
    return is.rlim_cur == RLIM_INFINITY ? std::string("none") : std::to_string(is.rlim_cur);
  };
  if (error == EMFILE)
    return "too many open files, this program's limit is " + limit(RLIMIT_NOFILE) + " (ulimit -n)";
  if (error == ENFILE) return "too many open files on this machine";
  if (error == EFBIG)
    return "too large, this program's limit is " + limit(RLIMIT_FSIZE) + " bytes a file (ulimit -f)";
  if (error == ENOMEM)
    return "not enough memory, this program's limit is " + limit(RLIMIT_AS) + " bytes (ulimit -v)";
  return "";
}

namespace {

bool maps(std::size_t bytes) {
  void* const place = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (place == MAP_FAILED) return false;
  munmap(place, bytes);
  return true;
}

}  // namespace

std::string lacking_resource() {
  const int descriptor = open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return lacking_resource(errno);
  close(descriptor);
  return maps(std::size_t{64} << 20) ? "" : lacking_resource(ENOMEM);
}

void require_address_space(std::size_t bytes, const std::string& work) {
  if (maps(bytes)) return;
  throw MachineError(lacking_resource(ENOMEM) + "; " + work + " takes " + std::to_string(bytes >> 20) +
                     " MiB more");
}

void require_stack() {
  constexpr std::size_t least = 500'000;  // drawing takes 200'000
  pthread_attr_t attributes;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return;
  void* lowest = nullptr;
  std::size_t bytes = least;
  pthread_attr_getstack(&attributes, &lowest, &bytes);
  pthread_attr_destroy(&attributes);
  if (bytes < least)
    throw MachineError("this thread's stack has " + std::to_string(bytes / 1000) + " kB, " +
                       std::to_string(least / 1000) + " are needed (ulimit -s)");
}

}  // namespace understory
