#pragma once

#include <chrono>

namespace understory {

/// Wall time since `begin`, s. For people and benchmarks; decides nothing in a flight.
inline double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace understory
