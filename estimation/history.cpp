#include "estimation/history.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/so3.hpp"

namespace understory {

void History::record(const State& state) {
  if (count_ > 0 && nth(count_ - 1).t_ns == state.t_ns) {
    nth(count_ - 1) = state;
    return;
  }
  // One state older than the span is kept, so that the whole span can be interpolated.
  while (count_ > 2 && nth(1).t_ns <= state.t_ns - length_ns_) {
    first_ = (first_ + 1) % ring_.size();
    --count_;
  }
  if (count_ == ring_.size()) make_room();
  nth(count_++) = state;
}

void History::make_room() {
  decltype(ring_) wider;
  wider.reserve(std::max<std::size_t>(16, 2 * ring_.size()));
  for (std::size_t i = 0; i < count_; ++i) wider.push_back(nth(i));
  wider.resize(wider.capacity());
  ring_.swap(wider);
  first_ = 0;
}

State History::at(std::int64_t t_ns) const {
  std::size_t later = 0, end = count_;  // the first state not before t_ns
  while (later < end) {
    const std::size_t middle = later + (end - later) / 2;
    if (nth(middle).t_ns < t_ns)
      later = middle + 1;
    else
      end = middle;
  }
  if (later == 0) return nth(0);
  if (later == count_) return nth(count_ - 1);
  const State& earlier = nth(later - 1);
  const double fraction =
      static_cast<double>(t_ns - earlier.t_ns) / static_cast<double>(nth(later).t_ns - earlier.t_ns);
  State state = interpolated(earlier, nth(later), fraction);
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
  state.accelerometer_bias_mps2 = between(from.accelerometer_bias_mps2, to.accelerometer_bias_mps2);
  state.wind_world_mps = between(from.wind_world_mps, to.wind_world_mps);
  state.gust_world_mps = between(from.gust_world_mps, to.gust_world_mps);
  state.pitot_bias_mps = from.pitot_bias_mps + fraction * (to.pitot_bias_mps - from.pitot_bias_mps);
  state.barometer_offset_m =
      from.barometer_offset_m + fraction * (to.barometer_offset_m - from.barometer_offset_m);
  state.altitude_m = from.altitude_m + fraction * (to.altitude_m - from.altitude_m);
  state.inertial_velocity_world_mps =
      between(from.inertial_velocity_world_mps, to.inertial_velocity_world_mps);
  state.inertial_position_world_m = between(from.inertial_position_world_m, to.inertial_position_world_m);
  state.covariance = between(from.covariance, to.covariance);
  state.distance_flown_m = from.distance_flown_m + fraction * (to.distance_flown_m - from.distance_flown_m);
  return state;
}

}  // namespace understory
