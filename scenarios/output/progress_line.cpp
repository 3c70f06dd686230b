#include "scenarios/output/progress_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>

namespace understory {
namespace {

constexpr double between_lines_s = 30;

std::atomic<bool> stands = false;

std::string in_words(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

ProgressLine::ProgressLine(bool shown)
    : is_shown_(shown),
      is_terminal_(shown && isatty(STDOUT_FILENO) == 1),
      next_line_s_(is_terminal_ ? 0 : between_lines_s) {}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::show(const std::string& text, std::size_t done, std::size_t left) {
  if (!is_shown_) return;
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  if (elapsed_s < next_line_s_) return;
  next_line_s_ = elapsed_s + (is_terminal_ ? 0.1 : between_lines_s);
  const double left_s = done == 0 ? 0 : elapsed_s / static_cast<double>(done) * static_cast<double>(left);
  fmt::print("{}{}{}{}", is_terminal_ ? "\r\033[K" : "", text,
             done == 0 ? "" : fmt::format(", {} left", in_words(left_s)), is_terminal_ ? "" : "\n");
  std::fflush(stdout);
  stands = is_terminal_;
}

void ProgressLine::clear() {
  if (is_terminal_) clear_any();
}

void ProgressLine::clear_any() {
  // Past stdout's buffer, which somebody may hold who waits for its reader.
  if (stands.exchange(false) && write(STDOUT_FILENO, "\r\033[K", 4) < 0) return;
}

}  // namespace understory
