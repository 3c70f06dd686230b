#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <random>

#include "perception/stereo_frame.hpp"

namespace understory {

/// The computer between cameras and autopilot. When it is free, it takes the newest frame that has arrived,
/// is busy for the detector's cost, and then hands the frame over. Of the frames that arrive meanwhile only
/// the newest is kept. With no cost it hands over every frame as it arrives. Exact to the nanosecond,
/// whatever the step size. Frames come in order of arrival.
class FlightComputer {
 public:
  explicit FlightComputer(std::int64_t cost_ns) : cost_ns_(cost_ns) {}

  /// Whether a frame with this arrival will be looked at, given that the next arrives at `next_arrival_ns`
  /// and later ones at the same interval. The caller may leave other frames empty. To be called once for
  /// every frame, in order.
  bool will_take(std::int64_t arrival_ns, std::int64_t next_arrival_ns);

  /// Adds a frame, not later than its arrival. `taken`: as will_take() said.
  void send(StereoFrame frame, std::int64_t arrival_ns, bool taken = true);
  /// From now on frames cost nothing, and those under way have arrived and been looked at.
  void hurry(std::int64_t t_ns);
  /// The next frame that has been looked at by t_ns; to be called until there is none. t_ns never decreases,
  /// and frames that arrived by then have been sent.
  std::optional<StereoFrame> next_frame(std::int64_t t_ns);

 private:
  struct Arrival {
    StereoFrame frame;
    std::int64_t t_ns = 0;
    bool taken = true;
  };

  std::int64_t cost_ns_;
  std::deque<Arrival> arrivals_;  // the first is being looked at where busy_
  bool busy_ = false;
  std::int64_t free_ns_ = 0;          // end of the newest frame that was taken
  std::int64_t planned_free_ns_ = 0;  // the same as predicted by will_take
};

/// Lost frames: independent, with the same probability. At 0 no random number is drawn.
class FrameDrops {
 public:
  FrameDrops(double probability, std::uint64_t seed) : probability_(probability), generator_(seed) {}
  /// Whether the next frame is lost.
  bool next() { return probability_ > 0 && std::bernoulli_distribution(probability_)(generator_); }

 private:
  double probability_;
  std::mt19937_64 generator_;
};

}  // namespace understory
