#pragma once

#include <source_location>
#include <stdexcept>
#include <string>

namespace understory {

/// An assertion that stays on in release. A breach is the caller's mistake, so it ends in std::logic_error
/// (an internal fault to whoever runs the program), never in a value somebody might use.
inline void assert_always(bool holds, const char* what,
                          std::source_location where = std::source_location::current()) {
  if (!holds)
    throw std::logic_error(std::string(where.file_name()) + ":" + std::to_string(where.line()) + ": " + what);
}

}  // namespace understory
