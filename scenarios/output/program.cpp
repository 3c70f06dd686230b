#include "scenarios/output/program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <string_view>

#include "scenarios/output/errors.hpp"
#include "scenarios/output/signals.hpp"

namespace understory {

namespace {

/// Makes the calling process, fresh from fork(), this program anew; 127 where that fails.
[[noreturn]] void become_this_program(const std::vector<std::string>& arguments) {
  std::vector<char*> argv{const_cast<char*>("understory")};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv("/proc/self/exe", argv.data());
  _exit(127);
}

}  // namespace

const char* const understory_version = UNDERSTORY_VERSION;

std::string program_digest() {
  std::ifstream stream("/proc/self/exe", std::ios::binary);
  const std::string binary{std::istreambuf_iterator<char>(stream), {}};
  return fmt::format("{:016x}", std::hash<std::string_view>{}(binary));
}

pid_t start_this_program(const std::vector<std::string>& arguments, int at_our_end,
                         const std::filesystem::path& log) {
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) throw MachineError(fmt::format("cannot start a flight: {}", std::strerror(errno)));
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
  become_this_program(arguments);
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

void ProgramProcesses::start(std::uint64_t tag, const std::vector<std::string>& arguments) {
  while (running_.size() >= static_cast<std::size_t>(maximum_count_)) wait_for_one();
  const pid_t child = start_this_program(arguments, SIGHUP);
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
