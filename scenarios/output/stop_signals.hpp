#pragma once

namespace understory {

/// While it lives, SIGINT, SIGTERM and SIGHUP end nothing: they are remembered, until the
/// outermost of several is gone. For one thread.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Whether one has come.
  bool asked() const;
};

}  // namespace understory
