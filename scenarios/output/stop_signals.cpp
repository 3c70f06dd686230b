#include "scenarios/output/stop_signals.hpp"

#include <array>
#include <csignal>

namespace understory {
namespace {

constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t is_asked = 0;
std::array<struct sigaction, signals.size()> before;
int living = 0;

}  // namespace

StopSignals::StopSignals() {
  if (living++ > 0) return;
  is_asked = 0;
  struct sigaction action {};
  action.sa_handler = [](int) { is_asked = 1; };
  for (std::size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &action, &before[i]);
}

StopSignals::~StopSignals() {
  if (--living > 0) return;
  for (std::size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &before[i], nullptr);
}

bool StopSignals::asked() const { return is_asked != 0; }

}  // namespace understory
