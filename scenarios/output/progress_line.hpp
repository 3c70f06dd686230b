#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace understory {

/// How far the work is: one line of standard output, written over and over on a terminal and gone with this
/// object. Elsewhere a line each half minute.
class ProgressLine {
 public:
  /// `shown`: false says nothing anywhere (--quiet).
  explicit ProgressLine(bool shown = true);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// `text`: how far it is, at most ten times a second. `done` since this line began, `left`: parts of one
  /// kind, for an estimate of the time left; none without them.
  void show(const std::string& text, std::size_t done = 0, std::size_t left = 0);
  /// Until the next show().
  void clear();
  /// Whatever line stands on the terminal, when the program ends without warning.
  static void clear_any();

 private:
  bool is_shown_, is_terminal_;
  double next_line_s_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace understory
