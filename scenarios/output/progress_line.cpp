#include "scenarios/output/progress_line.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace understory {
namespace {

std::string in_words(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

void ProgressLine::show(const std::string& text, std::size_t done, std::size_t left) {
  const double elapsed_s = stopwatch_.elapsed_s();
  if (!is_terminal_ && left > 0 && elapsed_s < next_line_s_) return;
  next_line_s_ = elapsed_s + 30;
  const double left_s = done == 0 ? 0 : elapsed_s / static_cast<double>(done) * static_cast<double>(left);
  fmt::print("{}{}{}{}", is_terminal_ ? "\r\033[K" : "", text,
             done == 0 ? "" : fmt::format(", {} left", in_words(left_s)), is_terminal_ ? "" : "\n");
  std::fflush(stdout);
}

void ProgressLine::clear() const {
  if (is_terminal_) fmt::print("\r\033[K");
}

}  // namespace understory
