#pragma once

#include <atomic>

/// For programs that count what they allocate: operator new is replaced, and malloc, which Eigen calls
/// directly, is wrapped (-Wl,--wrap=malloc). In a file of its own, since the compiler takes a delete that it
/// inlines beside a new that it does not for a mismatch.
namespace understory::support {

extern std::atomic<long> allocation_count;

}  // namespace understory::support
