#pragma once

#include <chrono>
#include <string>

namespace understory {

/// One line, again and again on a terminal and gone with this object, so that nothing stays before a
/// complaint or a summary; elsewhere a line each half minute.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// `text`: how far it is. `done` since this line began, `left`: parts of one kind, for an estimate of the
  /// time left; none where nothing is done.
  void show(const std::string& text, std::size_t done = 0, std::size_t left = 0);
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool is_terminal_, is_shown_ = false;
  Clock::time_point begin_ = Clock::now(), shown_ = begin_;
};

}  // namespace understory
