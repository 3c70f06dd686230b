#pragma once

#include <cstdio>
#include <cstdlib>

namespace understory {

/// A programming error ends the program, in release builds too: a flight that went on would be worth nothing.
inline void require(bool holds, const char* expectation) {
  if (holds) return;
  std::fprintf(stderr, "understory: internal fault: expected that %s\n", expectation);
  std::abort();
}

}  // namespace understory
