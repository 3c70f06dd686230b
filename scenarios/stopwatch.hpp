#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "scenarios/elapsed.hpp"
#include "scenarios/flight_result.hpp"

namespace understory {

/// Wall time per named stage, for people. Nothing reads it back while a flight runs.
class Stopwatch {
 public:
  /// Runs `work` and books its time under `stage`; gives back what `work` gives.
  template <typename Work>
  decltype(auto) time(const char* stage, Work&& work) {
    const Booking booking{*this, stage};
    return work();
  }

  const std::vector<StageTiming>& timings() const { return timings_; }
  double elapsed_s() const { return seconds_since(start_); }

 private:
  using Clock = std::chrono::steady_clock;

  struct Booking {
    Stopwatch& stopwatch;
    const char* stage;
    Clock::time_point begin = Clock::now();
    ~Booking() { stopwatch.book(stage, seconds_since(begin)); }
  };

  void book(const char* stage, double seconds) {
    auto timing = std::find_if(timings_.begin(), timings_.end(),
                               [&](const StageTiming& other) { return other.stage == stage; });
    if (timing == timings_.end()) timing = timings_.insert(timings_.end(), StageTiming{stage, 0, 0, 0});
    timing->count += 1;
    timing->total_s += seconds;
    timing->greatest_s = std::max(timing->greatest_s, seconds);
  }

  Clock::time_point start_ = Clock::now();
  std::vector<StageTiming> timings_;
};

}  // namespace understory
