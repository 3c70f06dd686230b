#pragma once

#include <unistd.h>

#include <string>

#include "scenarios/flight/stopwatch.hpp"

namespace understory {

/// One line, again and again on a terminal; elsewhere a line each half minute.
class ProgressLine {
 public:
  /// `text`: how far it is. `done` since this line began, `left`: parts of one kind, for an estimate of the
  /// time left.
  void show(const std::string& text, std::size_t done, std::size_t left);
  void clear() const;

 private:
  bool is_terminal_ = isatty(STDOUT_FILENO) == 1;
  double next_line_s_ = 0;
  Stopwatch stopwatch_;
};

}  // namespace understory
