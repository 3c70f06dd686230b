#include "estimation/history.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/so3.hpp"

namespace understory {

void History::record(const State& state) {
  if (!states_.empty() && states_.back().t_ns == state.t_ns) states_.pop_back();
  states_.push_back(state);
  // One state older than the span is kept, so that the whole span can be interpolated.
  while (states_.size() > 2 && states_[1].t_ns <= state.t_ns - length_ns_) states_.pop_front();
}

State History::at(std::int64_t t_ns) const {
  const auto later = std::lower_bound(states_.begin(), states_.end(), t_ns,
                                      [](const State& state, std::int64_t t) { return state.t_ns < t; });
  if (later == states_.begin()) return states_.front();
  if (later == states_.end()) return states_.back();
  const State& earlier = *std::prev(later);
  const double fraction =
      static_cast<double>(t_ns - earlier.t_ns) / static_cast<double>(later->t_ns - earlier.t_ns);
  State state = interpolated(earlier, *later, fraction);
  state.t_ns = t_ns;
  return state;
}

State interpolated(const State& from, const State& to, double fraction) {
  const auto between = [fraction](const auto& a, const auto& b) { return (a + fraction * (b - a)).eval(); };
  State state;
  state.t_ns = from.t_ns + std::llround(fraction * static_cast<double>(to.t_ns - from.t_ns));
  const Eigen::Matrix3d start = from.T_world_body.linear();
  state.T_world_body.linear() =
      start * so3::exp(fraction * so3::log(start.transpose() * to.T_world_body.linear()));
  state.T_world_body.translation() = between(from.T_world_body.translation(), to.T_world_body.translation());
  state.velocity_body_mps = between(from.velocity_body_mps, to.velocity_body_mps);
  state.angular_rate_body_radps = between(from.angular_rate_body_radps, to.angular_rate_body_radps);
  state.specific_force_body_mps2 = between(from.specific_force_body_mps2, to.specific_force_body_mps2);
  state.gyro_bias_radps = between(from.gyro_bias_radps, to.gyro_bias_radps);
  state.covariance = between(from.covariance, to.covariance);
  state.distance_flown_m = from.distance_flown_m + fraction * (to.distance_flown_m - from.distance_flown_m);
  return state;
}

}  // namespace understory
