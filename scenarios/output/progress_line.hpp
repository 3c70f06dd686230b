#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace understory {

/// How far the work is: one line of standard output, rewritten on a terminal and removed with this object.
/// Elsewhere a line each half minute.
class ProgressLine {
 public:
  /// `shown`: false prints nothing at all (--quiet).
  explicit ProgressLine(bool shown = true);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// `text`: how far it is, at most ten times a second. `done` parts since this line began and `left` parts
  /// give an estimate of the time left; none if `done` is 0.
  void show(const std::string& text, std::size_t done = 0, std::size_t left = 0);
  /// Removes the line until the next show().
  void clear();
  /// Removes any progress line from the terminal, when the program ends without warning.
  static void clear_any();

 private:
  bool is_shown_, is_terminal_;
  double next_line_s_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace understory
