#pragma once

#include <cstdint>
#include <deque>

#include "estimation/state.hpp"

namespace understory {

/// The last `length` of states, for whoever asks what was (an image is delivered later than it was taken).
class History {
 public:
  explicit History(std::int64_t length_ns) : length_ns_(length_ns) {}
  /// `state.t_ns` must not be before the newest; a state of the same moment replaces it.
  void record(const State& state);
  /// Interpolated (rotation on the manifold, the rest linearly); the nearest end outside the recorded span.
  /// Precondition: something was recorded.
  State at(std::int64_t t_ns) const;

 private:
  std::int64_t length_ns_;
  std::deque<State, Eigen::aligned_allocator<State>> states_;
};

/// The state a `fraction` (0..1) of the way from one to the other.
State interpolated(const State& from, const State& to, double fraction);

}  // namespace understory
