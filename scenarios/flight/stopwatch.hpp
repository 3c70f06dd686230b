#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "scenarios/flight/elapsed.hpp"
#include "scenarios/flight/flight_result.hpp"

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
    StageTiming& timing = timings_[place_of(stage)];
    timing.count += 1;
    timing.total_s += seconds;
    timing.maximum_s = std::max(timing.maximum_s, seconds);
  }

  /// Several thousand times a simulated second, nearly always with a pointer that has come before.
  std::size_t place_of(const char* stage) {
    const auto known = std::find_if(places_.begin(), places_.end(),
                                    [stage](const Place& place) { return place.name == stage; });
    if (known != places_.end()) return known->timing;
    const auto named = std::find_if(timings_.begin(), timings_.end(),
                                    [stage](const StageTiming& timing) { return timing.stage == stage; });
    places_.push_back({stage, static_cast<std::size_t>(named - timings_.begin())});
    if (named == timings_.end()) timings_.push_back(StageTiming{stage, 0, 0, 0});
    return places_.back().timing;
  }

  struct Place {
    const char* name;  ///< a literal
    std::size_t timing;
  };

  Clock::time_point start_ = Clock::now();
  std::vector<StageTiming> timings_;
  std::vector<Place> places_;
};

}  // namespace understory
