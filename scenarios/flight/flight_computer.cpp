#include "scenarios/flight/flight_computer.hpp"

#include <algorithm>
#include <utility>

namespace understory {

bool FlightComputer::will_take(std::int64_t arrival_ns, std::int64_t next_arrival_ns) {
  const std::int64_t start_ns = std::max(arrival_ns, planned_free_ns_);
  if (cost_ns_ > 0 && next_arrival_ns <= start_ns) return false;
  planned_free_ns_ = start_ns + cost_ns_;
  return true;
}

void FlightComputer::send(StereoFrame frame, std::int64_t arrival_ns, bool taken) {
  arrivals_.push_back({std::move(frame), arrival_ns, taken});
}

void FlightComputer::hurry(std::int64_t t_ns) {
  cost_ns_ = 0;
  std::erase_if(arrivals_, [](const Arrival& arrival) { return !arrival.taken; });
  for (Arrival& arrival : arrivals_) arrival.t_ns = std::min(arrival.t_ns, t_ns);
  free_ns_ = std::min(free_ns_, t_ns);
  planned_free_ns_ = std::min(planned_free_ns_, t_ns);
}

std::optional<StereoFrame> FlightComputer::next_frame(std::int64_t t_ns) {
  if (!busy_) {
    if (arrivals_.empty()) return std::nullopt;
    const std::int64_t start_ns = std::max(free_ns_, arrivals_.front().t_ns);
    if (start_ns > t_ns) return std::nullopt;
    while (cost_ns_ > 0 && arrivals_.size() > 1 && arrivals_[1].t_ns <= start_ns) arrivals_.pop_front();
    busy_ = true;
    free_ns_ = start_ns + cost_ns_;
  }
  if (free_ns_ > t_ns) return std::nullopt;
  busy_ = false;
  StereoFrame frame = std::move(arrivals_.front().frame);
  arrivals_.pop_front();
  return frame;
}

}  // namespace understory
