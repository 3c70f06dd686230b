#pragma once

#include "estimation/state_source.hpp"
#include "scenarios/flight/oracles/truth_history.hpp"

namespace understory {

/// The truth in place of the filter: no error, no covariance. Keeps a reference to the history.
class TrueState : public StateSource {
 public:
  explicit TrueState(const TruthHistory& history) : history_(history) {}
  void on(const ImuSample& sample) override;
  void on(const PitotSample&) override {}
  void on(const BarometerSample&) override {}
  void on(const MagnetometerSample&) override {}
  void on(const GpsSample&) override {}
  void on(const ResightingSample&) override {}
  const State& state() const override { return state_; }
  State state_at(std::int64_t t_ns) const override;

 private:
  const TruthHistory& history_;
  State state_;
};

/// A truth as a State with no error.
State state_of(const Truth& truth);

}  // namespace understory
