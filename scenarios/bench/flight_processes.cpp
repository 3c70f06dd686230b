#include "scenarios/bench/flight_processes.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "scenarios/output/file_output.hpp"
#include "scenarios/output/program.hpp"

namespace understory {

void FlightProcesses::start(std::uint64_t tag, const std::vector<std::string>& arguments) {
  while (running_.size() >= static_cast<std::size_t>(maximum_count_)) wait_for_one();
  const pid_t child = fork();
  if (child < 0) throw MachineError(fmt::format("cannot start a flight: {}", std::strerror(errno)));
  if (child == 0) become_this_program(arguments);
  running_[child] = tag;
}

void FlightProcesses::wait_for_one() {
  int status = 0;
  struct rusage usage {};
  const pid_t child = wait4(-1, &status, 0, &usage);
  if (child < 0 && errno == EINTR) return;
  if (child < 0) throw MachineError(fmt::format("cannot wait for a flight: {}", std::strerror(errno)));
  const auto ended = running_.find(child);
  if (ended == running_.end()) return;
  const std::uint64_t tag = ended->second;
  running_.erase(ended);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  use_ = {seconds(usage.ru_utime) + seconds(usage.ru_stime), std::int64_t{1024} * usage.ru_maxrss};
  on_end_(tag, WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
}

void FlightProcesses::wait_for_all() {
  while (!running_.empty()) wait_for_one();
}

}  // namespace understory
