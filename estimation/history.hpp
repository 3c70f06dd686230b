#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimation/state.hpp"

namespace understory {

/// The states of the last `length`, because images arrive later than they were taken. A ring that grows until
/// it holds the span and allocates nothing after that.
class History {
 public:
  explicit History(std::int64_t length_ns) : length_ns_(length_ns) {}
  /// `state.t_ns` must not be before the newest; a state of the same moment replaces it.
  void record(const State& state);
  /// Removes all states; keeps the memory.
  void clear() { count_ = 0; }
  /// Interpolated (rotation on the manifold, the rest linearly); the nearest end outside the recorded span.
  /// Precondition: something was recorded.
  State at(std::int64_t t_ns) const;

 private:
  State& nth(std::size_t i) { return ring_[(first_ + i) % ring_.size()]; }
  const State& nth(std::size_t i) const { return ring_[(first_ + i) % ring_.size()]; }
  void make_room();

  std::int64_t length_ns_;
  std::vector<State, Eigen::aligned_allocator<State>> ring_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

/// The state a `fraction` (0..1) of the way from one to the other.
State interpolated(const State& from, const State& to, double fraction);

}  // namespace understory
