#include "scenarios/output/program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <string_view>
#include <system_error>

#include "perception/io/machine_limits.hpp"
#include "scenarios/output/errors.hpp"
#include "scenarios/output/signals.hpp"

namespace understory {

const char* const understory_version = UNDERSTORY_VERSION;
const char* understory_commit = "unknown";

std::string digest_of_text(std::string_view text) {
  return fmt::format("{:016x}", std::hash<std::string_view>{}(text));
}

std::string digest_of_file(const std::filesystem::path& file) {
  // Files are mapped: a campaign asks for every library of the process, some hundred megabytes.
  std::error_code error;
  const std::uintmax_t size = std::filesystem::is_regular_file(file, error) ? file_size(file, error) : 0;
  const int descriptor = error || size == 0 ? -1 : open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (const std::string lacking = size > 0 && descriptor < 0 ? lacking_resource(errno) : ""; !lacking.empty())
    throw MachineError(file.string() + ": " + lacking);
  if (descriptor >= 0) {
    void* bytes = mmap(nullptr, size, PROT_READ, MAP_PRIVATE | MAP_POPULATE, descriptor, 0);
    close(descriptor);
    if (bytes != MAP_FAILED) {
      std::string digest = digest_of_text({static_cast<const char*>(bytes), size});
      munmap(bytes, size);
      return digest;
    }
  }
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  return digest_of_text(content);
}

std::string program_digest() { return digest_of_file("/proc/self/exe"); }

std::string mapped_libraries_digest() {
  std::set<std::string> files;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    const std::size_t path = line.find('/');
    if (path != std::string::npos && line.find(".so", path) != std::string::npos)
      files.insert(line.substr(path));
  }
  std::set<std::string> digests;  // wherever they lie
  for (const std::string& file : files) digests.insert(digest_of_file(file));
  std::string all;
  for (const std::string& digest : digests) all += digest + '\n';
  return digest_of_text(all);
}

std::string difference_of(const Identity& one, const Identity& other) {
  const auto lacks = [](const Identity& identity, const auto& entry) {
    return std::ranges::find(identity, entry) == identity.end();
  };
  for (const auto& entry : one)
    if (lacks(other, entry)) return entry.first;
  for (const auto& entry : other)
    if (lacks(one, entry)) return entry.first;
  return "";
}

std::string processor_model() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(": ") + 2));
  return "";
}

void repair_surroundings() {
  // A file that takes descriptor 1 or 2 would get what is printed.
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(standard, F_GETFD) < 0 && open("/dev/null", O_RDWR) != standard) std::_Exit(3);
  std::signal(SIGCHLD, SIG_DFL);
  std::signal(SIGXFSZ, SIG_IGN);
}

pid_t start_this_program(const std::vector<std::string>& arguments, int at_our_end,
                         const std::filesystem::path& log, const std::filesystem::path& program) {
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0)
    throw MachineError(
        fmt::format("cannot start another process: {} (ulimit -u, ulimit -v)", std::strerror(errno)));
  if (child != 0) return child;
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, at_our_end);
  if (getppid() != parent) _exit(127);
  if (!log.empty()) {
    const int nothing = open("/dev/null", O_RDWR);
    const int log_file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (nothing < 0 || log_file < 0) _exit(127);
    dup2(nothing, STDIN_FILENO);
    dup2(nothing, STDOUT_FILENO);
    dup2(log_file, STDERR_FILENO);
  }
  std::vector<char*> argv{const_cast<char*>("understory")};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv(program.empty() ? "/proc/self/exe" : program.c_str(), argv.data());
  _exit(127);
}

EndedProcess wait_for_process(pid_t pid, int options) {
  EndedProcess ended;
  struct rusage usage {};
  do ended.pid = wait4(pid, &ended.wait_status, options, &usage);
  while (ended.pid < 0 && errno == EINTR);
  if (ended.pid < 0) throw MachineError(fmt::format("cannot wait for a flight: {}", std::strerror(errno)));
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  ended.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  ended.peak_memory_mb = 1.024e-3 * static_cast<double>(usage.ru_maxrss);
  return ended;
}

std::string last_line_of(const std::filesystem::path& log) {
  constexpr std::string_view name = "understory: ";
  std::ifstream stream(log);
  std::string last;
  for (std::string line; std::getline(stream, line);)
    if (!line.empty()) last = line;
  return last.starts_with(name) ? last.substr(name.size()) : last;
}

void ProgramProcesses::start(std::uint64_t tag, const std::vector<std::string>& arguments,
                             const std::filesystem::path& log) {
  while (running_.size() >= static_cast<std::size_t>(maximum_count_)) wait_for_one();
  const pid_t child = start_this_program(arguments, SIGHUP, log);
  ends_with_us(child);
  running_[child] = tag;
}

void ProgramProcesses::wait_for_one() {
  const EndedProcess process = wait_for_process(-1);
  const auto ended = running_.find(process.pid);
  if (ended == running_.end()) return;
  const std::uint64_t tag = ended->second;
  running_.erase(ended);
  has_ended(process.pid);
  const int status = process.wait_status;
  on_end_(tag, WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), process);
}

void ProgramProcesses::wait_for_all() {
  while (!running_.empty()) wait_for_one();
}

}  // namespace understory
