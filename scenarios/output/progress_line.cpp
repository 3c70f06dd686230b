#include "scenarios/output/progress_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace understory {
namespace {

constexpr std::chrono::milliseconds on_terminals_every{50};
constexpr std::chrono::seconds elsewhere_every{30};

std::string in_words(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

ProgressLine::ProgressLine() : is_terminal_(isatty(STDOUT_FILENO) == 1) {}

void ProgressLine::show(const std::string& text, std::size_t done, std::size_t left) {
  const Clock::time_point now = Clock::now();
  if (is_terminal_ ? is_shown_ && now - shown_ < on_terminals_every : now - shown_ < elsewhere_every) return;
  shown_ = now;
  is_shown_ = true;
  const double left_s = std::chrono::duration<double>(now - begin_).count() * static_cast<double>(left) /
                        static_cast<double>(done > 0 ? done : 1);
  fmt::print("{}{}{}{}", is_terminal_ ? "\r\033[K" : "", text,
             done == 0 ? "" : fmt::format(", {} left", in_words(left_s)), is_terminal_ ? "" : "\n");
  std::fflush(stdout);
}

void ProgressLine::clear() {
  if (is_terminal_ && is_shown_) fmt::print("\r\033[K");
  is_shown_ = false;
  std::fflush(stdout);
}

}  // namespace understory
