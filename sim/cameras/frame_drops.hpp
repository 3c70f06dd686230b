#pragma once

#include <cstdint>
#include <random>

namespace understory {

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
