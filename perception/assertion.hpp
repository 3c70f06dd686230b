#pragma once

#include <stdexcept>
#include <string>

namespace understory {

/// An assertion that stays on in release. A violation is a mistake of the caller, so it throws
/// std::logic_error (for the user an internal fault) and never returns a wrong value. (The builtins replace
/// std::source_location, which clang 14 with libstdc++ 12 does not have.)
inline void assert_always(bool holds, const char* what, const char* file = __builtin_FILE(),
                          int line = __builtin_LINE()) {
  if (!holds) throw std::logic_error(std::string(file) + ":" + std::to_string(line) + ": " + what);
}

}  // namespace understory
