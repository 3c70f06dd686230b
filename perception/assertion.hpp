#pragma once

#include <stdexcept>
#include <string>

namespace understory {

/// An assertion that stays on in release. A breach is the caller's mistake, so it ends in std::logic_error
/// (an internal fault to whoever runs the program), never in a value somebody might use.
/// (The builtins are std::source_location's, which clang 14 with libstdc++ 12 does not have.)
inline void assert_always(bool holds, const char* what, const char* file = __builtin_FILE(),
                          int line = __builtin_LINE()) {
  if (!holds) throw std::logic_error(std::string(file) + ":" + std::to_string(line) + ": " + what);
}

}  // namespace understory
