#include "scenarios/flight/oracles/true_state.hpp"

namespace understory {

State state_of(const Truth& truth) {
  State state;
  state.t_ns = truth.t_ns;
  state.T_world_body = truth.T_world_body;
  state.altitude_m = truth.T_world_body.translation().z();
  state.velocity_body_mps = truth.T_world_body.linear().transpose() * truth.velocity_world_mps;
  state.angular_rate_body_radps = truth.angular_rate_body_radps;
  state.specific_force_body_mps2 = truth.specific_force_body_mps2;
  return state;
}

void TrueState::on(const ImuSample& sample) {
  State next = state_of(history_.at(sample.t_ns));
  const double elapsed_s = state_.t_ns == 0 ? 0 : static_cast<double>(next.t_ns - state_.t_ns) * 1e-9;
  next.distance_flown_m = state_.distance_flown_m + elapsed_s * next.velocity_body_mps.norm();
  state_ = next;
}

State TrueState::state_at(std::int64_t t_ns) const {
  State then = state_of(history_.at(t_ns));
  const double since_s = static_cast<double>(state_.t_ns - then.t_ns) * 1e-9;
  then.distance_flown_m = state_.distance_flown_m - since_s * state_.velocity_body_mps.norm();
  return then;
}

}  // namespace understory
