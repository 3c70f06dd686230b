#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string_view>
#include <vector>

#include "scenarios/flight/flight_result.hpp"

namespace understory {

/// Wall time since `begin`, s. For people and benchmarks; decides nothing in a flight.
inline double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Wall time per named stage, for people. No flight reads it.
class Stopwatch {
  using Clock = std::chrono::steady_clock;

 public:
  /// Counts the time until it goes out of scope.
  class Booking {
   public:
    Booking(Stopwatch& stopwatch, std::size_t timing) : stopwatch_(stopwatch), timing_(timing) {}
    ~Booking() {
      const double seconds = seconds_since(begin_);
      StageTiming& timing = stopwatch_.timings_[timing_];
      timing.count += 1;
      timing.total_s += seconds;
      timing.maximum_s = std::max(timing.maximum_s, seconds);
    }
    Booking(const Booking&) = delete;
    Booking& operator=(const Booking&) = delete;

   private:
    Stopwatch& stopwatch_;
    std::size_t timing_;
    Clock::time_point begin_ = Clock::now();
  };

  [[nodiscard]] Booking time(std::string_view stage) {
    const auto known =
        std::ranges::find_if(timings_, [stage](const StageTiming& timing) { return timing.stage == stage; });
    const auto place = static_cast<std::size_t>(known - timings_.begin());
    if (known == timings_.end()) timings_.push_back({std::string(stage), 0, 0, 0});
    return {*this, place};
  }
  /// Times `work` and returns its value.
  template <typename Work>
  decltype(auto) time(std::string_view stage, Work&& work) {
    const Booking booking = time(stage);
    return work();
  }

  const std::vector<StageTiming>& timings() const { return timings_; }
  double elapsed_s() const { return seconds_since(start_); }

 private:
  Clock::time_point start_ = Clock::now();
  std::vector<StageTiming> timings_;
};

}  // namespace understory
