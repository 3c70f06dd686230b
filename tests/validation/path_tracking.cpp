#include "tests/validation/path_tracking.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/flight/oracles.hpp"

namespace understory {
namespace {

constexpr double minimum_lift_mps2 = 2;       // upwards: the bank never passes the vertical
constexpr int physics_steps_per_control = 6;  // 200 Hz, the rate of the stack's IMU

/// The record at `t_s`, between its moments; its ends beyond them.
RecordedMoment moment_at(const FlightRecord& record, double t_s) {
  const std::vector<RecordedMoment>& moments = record.moments;
  const auto after = std::find_if(moments.begin(), moments.end(),
                                  [t_s](const RecordedMoment& moment) { return moment.t_s > t_s; });
  if (after == moments.begin()) return moments.front();
  if (after == moments.end()) return moments.back();
  const RecordedMoment& before = *(after - 1);
  const double share = (t_s - before.t_s) / (after->t_s - before.t_s);
  RecordedMoment between = before;
  between.position_world += share * (after->position_world - before.position_world);
  between.velocity_body_mps += share * (after->velocity_body_mps - before.velocity_body_mps);
  between.R_world_body = Eigen::Quaterniond(before.R_world_body)
                             .slerp(share, Eigen::Quaterniond(after->R_world_body))
                             .toRotationMatrix();
  return between;
}

Eigen::Vector3d velocity_world(const RecordedMoment& moment) {
  return moment.R_world_body * moment.velocity_body_mps;
}

/// Of the record's own velocities, over a tenth of a second: shorter and their noise shows.
Eigen::Vector3d acceleration_world(const FlightRecord& record, double t_s) {
  constexpr double half_s = 0.05;
  const double last_s = record.moments.back().t_s;
  const double from_s = std::clamp(t_s - half_s, 0.0, last_s - 2 * half_s);
  return (velocity_world(moment_at(record, from_s + 2 * half_s)) -
          velocity_world(moment_at(record, from_s))) /
         (2 * half_s);
}

State state_relative_to_start(const Truth& truth) {
  State state = state_of(truth);
  state.T_world_body.translation().z() -= start_altitude_m;
  return state;
}

}  // namespace

FlightCommand tracking_command(const FlightModel& model, const TrackingConfig& config,
                               const FlightRecord& record, const State& state, double t_s) {
  const RecordedMoment path = moment_at(record, t_s);
  const Eigen::Vector3d velocity = state.T_world_body.linear() * state.velocity_body_mps;
  const Eigen::Vector3d back =
      config.swing_radps * config.swing_radps * (path.position_world - state.T_world_body.translation()) +
      2 * config.damping * config.swing_radps * (velocity_world(path) - velocity);
  const double heading = std::atan2(velocity.y(), velocity.x());
  const Eigen::Vector3d right(std::sin(heading), -std::cos(heading), 0);
  const Eigen::Vector3d wanted = acceleration_world(record, t_s + config.lead_s) + back;
  const double gravity_mps2 = model.airframe().gravity_mps2;
  const double upward_mps2 = std::max(minimum_lift_mps2, gravity_mps2 + wanted.z());
  const double aside_mps2 = wanted.dot(right);
  const FlightState now = flight_state(state);
  FlightCommand command;
  command.bank_rad = std::atan2(aside_mps2, upward_mps2);
  // The follower takes a climb error out over climb_angle_time_s: what it must be for this lift at the bank
  // there is.
  const double lift_mps2 = std::hypot(aside_mps2, upward_mps2);
  command.climb_mps =
      velocity.z() + model.config().climb_angle_time_s * (lift_mps2 * std::cos(now.bank_rad) - gravity_mps2);
  return command;
}

Replay track(const FreeFlight& air, const Airframe& airframe, const TrackingConfig& config,
             const FlightRecord& record) {
  const FlightModel model(airframe, config.flight_model);
  Aircraft aircraft = air.begin(airframe, record.start());
  Replay flown;
  Controls controls;
  std::int64_t step = 0;
  for (const RecordedMoment& moment : record.moments) {
    for (; step < std::llround(moment.t_s * physics_rate_hz); ++step) {
      if (step % physics_steps_per_control == 0) {
        const State state = state_relative_to_start(aircraft.truth());
        const double t_s = static_cast<double>(step) / physics_rate_hz;
        controls = follow(model, config.follower, tracking_command(model, config, record, state, t_s), state);
      }
      aircraft.step(controls);
    }
    flown.push_back(replayed_moment(aircraft.truth(), moment.t_s));
  }
  return flown;
}

double distance_to_path_m(const FlightRecord& record, const Eigen::Vector3d& position_world) {
  double minimum = HUGE_VAL;
  for (std::size_t i = 1; i < record.moments.size(); ++i) {
    const Eigen::Vector3d from = record.moments[i - 1].position_world;
    const Eigen::Vector3d along = record.moments[i].position_world - from;
    const double share = std::clamp((position_world - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    minimum = std::min(minimum, (position_world - from - share * along).norm());
  }
  return minimum;
}

}  // namespace understory
