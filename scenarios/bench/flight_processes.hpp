#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace understory {

/// Runs copies of this very program, a few at a time: one process flies one flight, since OMPL's random
/// generator is one per process.
class FlightProcesses {
 public:
  /// Called with the tag of a process and its exit status (128 + signal where it was killed).
  using OnEnd = std::function<void(std::uint64_t tag, int status)>;

  FlightProcesses(int maximum_count, OnEnd on_end)
      : maximum_count_(maximum_count), on_end_(std::move(on_end)) {}

  /// Starts this program with `arguments` (without the program's name); first waits where all places are
  /// taken.
  void start(std::uint64_t tag, const std::vector<std::string>& arguments);
  void wait_for_all();

  /// What the process used whose end is being told.
  struct Use {
    double cpu_s = 0;                    ///< of all its threads, in the kernel too
    std::int64_t peak_memory_bytes = 0;  ///< maximum resident set
  };
  const Use& use() const { return use_; }

 private:
  void wait_for_one();

  int maximum_count_;
  OnEnd on_end_;
  std::map<pid_t, std::uint64_t> running_;
  Use use_;
};

}  // namespace understory
