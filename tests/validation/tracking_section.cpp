#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "planning/path_follower.hpp"
#include "scenarios/parts/oracles.hpp"
#include "tests/validation/sections.hpp"

namespace understory {
namespace {

constexpr double minimum_lift_mps2 = 2;       // upwards: the bank never passes the vertical
constexpr int physics_steps_per_control = 6;  // 200 Hz, the rate of the stack's IMU

// How a flown path is held: the acceleration across it that the path itself has, called for early by what the
// aircraft lags behind, and what brings the aircraft back as a damped swing. The bank points the lift along
// the sum of this acceleration and gravity's opposite, the climb command makes its upward part.
constexpr double lead_s =
    0.20;  // input delay 0.02 s, lag of the angle of attack 0.17 s, half a control period
constexpr double swing_radps = 3.0;  // slower than the bank loop (9 rad/s), faster than the jog
constexpr double swing_damping = 1;  // critical: no swinging through the path

/// The record at `t_s`, between its moments; its ends beyond them.
FlightMoment moment_at(const FlightRecord& record, double t_s) {
  const auto after = std::find_if(record.begin(), record.end(),
                                  [t_s](const FlightMoment& moment) { return moment.t_s > t_s; });
  if (after == record.begin()) return record.front();
  if (after == record.end()) return record.back();
  const FlightMoment& before = *(after - 1);
  const double share = (t_s - before.t_s) / (after->t_s - before.t_s);
  FlightMoment between = before;
  between.position_world += share * (after->position_world - before.position_world);
  between.velocity_body_mps += share * (after->velocity_body_mps - before.velocity_body_mps);
  between.R_world_body = Eigen::Quaterniond(before.R_world_body)
                             .slerp(share, Eigen::Quaterniond(after->R_world_body))
                             .toRotationMatrix();
  return between;
}

Eigen::Vector3d velocity_world(const FlightMoment& moment) {
  return moment.R_world_body * moment.velocity_body_mps;
}

/// Of the record's own velocities, over a tenth of a second: shorter and their noise shows.
Eigen::Vector3d acceleration_world(const FlightRecord& record, double t_s) {
  constexpr double half_s = 0.05;
  const double from_s = std::clamp(t_s - half_s, 0.0, record.back().t_s - 2 * half_s);
  return (velocity_world(moment_at(record, from_s + 2 * half_s)) -
          velocity_world(moment_at(record, from_s))) /
         (2 * half_s);
}

/// The command that keeps to the record's path at `t_s` of it.
FlightCommand tracking_command(const FlightModel& model, const FlightRecord& record, const State& state,
                               double t_s) {
  const FlightMoment path = moment_at(record, t_s);
  const Eigen::Vector3d velocity = state.T_world_body.linear() * state.velocity_body_mps;
  const Eigen::Vector3d back =
      swing_radps * swing_radps * (path.position_world - state.T_world_body.translation()) +
      2 * swing_damping * swing_radps * (velocity_world(path) - velocity);
  const double heading = std::atan2(velocity.y(), velocity.x());
  const Eigen::Vector3d right(std::sin(heading), -std::cos(heading), 0);
  const Eigen::Vector3d wanted = acceleration_world(record, t_s + lead_s) + back;
  const double gravity_mps2 = model.airframe().gravity_mps2;
  const double upward_mps2 = std::max(minimum_lift_mps2, gravity_mps2 + wanted.z());
  const double aside_mps2 = wanted.dot(right);
  // The follower takes a climb error out over climb_angle_time_s: what it must be for this lift at the bank
  // there is.
  const double lift_mps2 = std::hypot(aside_mps2, upward_mps2);
  FlightCommand command;
  command.bank_rad = std::atan2(aside_mps2, upward_mps2);
  command.climb_mps = velocity.z() + model.config().climb_angle_time_s *
                                         (lift_mps2 * std::cos(flight_state(state).bank_rad) - gravity_mps2);
  return command;
}

/// The record's path flown by the path follower, which sees the true state, from the recorded start.
FlightRecord tracked(const FreeFlight& air, const FlightModel& model, const FlightRecord& record) {
  Aircraft aircraft = air.begin(model.airframe(), start_of(record));
  FlightRecord flown;
  Controls controls;
  std::int64_t step = 0;
  for (const FlightMoment& moment : record) {
    for (; step < std::llround(moment.t_s * physics_rate_hz); ++step) {
      if (step % physics_steps_per_control == 0) {
        State state = state_of(aircraft.truth());
        state.T_world_body.translation().z() -= start_altitude_m;
        const double t_s = static_cast<double>(step) / physics_rate_hz;
        controls = follow(model, {}, tracking_command(model, record, state, t_s), state);
      }
      aircraft.step(controls);
    }
    flown.push_back(moment_of(aircraft.truth(), moment.t_s));
  }
  return flown;
}

/// Distance of a point to the record's path (straight between its moments), wherever on it the aircraft is.
double distance_to_path_m(const FlightRecord& record, const Eigen::Vector3d& position_world) {
  double minimum = HUGE_VAL;
  for (std::size_t i = 1; i < record.size(); ++i) {
    const Eigen::Vector3d from = record[i - 1].position_world;
    const Eigen::Vector3d along = record[i].position_world - from;
    const double share = std::clamp((position_world - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    minimum = std::min(minimum, (position_world - from - share * along).norm());
  }
  return minimum;
}

double mean_speed_mps(const FlightRecord& record) {
  double sum = 0;
  for (const FlightMoment& moment : record) sum += moment.velocity_body_mps.norm();
  return sum / static_cast<double>(record.size());
}

double time_s(const FlightMoment& moment) { return moment.t_s; }
double x_m(const FlightMoment& moment) { return moment.position_world.x(); }
double y_m(const FlightMoment& moment) { return moment.position_world.y(); }
double roll_deg(const FlightMoment& moment) { return moment.roll_rad() / degree; }
double angle_of_attack_deg(const FlightMoment& moment) {
  return std::atan2(-moment.velocity_body_mps.z(), moment.velocity_body_mps.x()) / degree;
}

}  // namespace

Section tracking_section(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record) {
  FlightModelConfig config;
  config.cruise_speed_mps = mean_speed_mps(record);
  const FlightRecord flown = tracked(air, FlightModel(airframe, config), record);

  Series to_path{"to its path"}, to_moment{"to where it was at that time"};
  to_path.colour = 2;
  to_moment.colour = 0;
  to_moment.mark = Mark::dashes;
  for (std::size_t i = 0; i < flown.size(); ++i) {
    for (Series* series : {&to_path, &to_moment}) series->x.push_back(record[i].t_s);
    to_path.y.push_back(distance_to_path_m(record, flown[i].position_world));
    to_moment.y.push_back((flown[i].position_world - record[i].position_world).norm());
  }
  const double worst = *std::max_element(to_path.y.begin(), to_path.y.end());
  const double worst_moment = *std::max_element(to_moment.y.begin(), to_moment.y.end());
  const auto panel = [&](const char* title, const char* x_label, const char* y_label, auto x, auto y) {
    return LinePlot{
        title,
        x_label,
        y_label,
        {plotted("record", record, x, y, Mark::line, 7), plotted("follower", flown, x, y, Mark::line, 2)}};
  };
  LinePlot path = panel("Path from above", "forward (m)", "left (m)", x_m, y_m);
  path.equal_scale = true;
  LinePlot distance{"Distance from the record", "time (s)", "distance (m)", {to_path, to_moment}};
  distance.references = {{0.40, "asked: 0.40 m to the path"}};
  LinePlot attacks =
      panel("Angle of attack", "time (s)", "angle of attack (deg)", time_s, angle_of_attack_deg);
  attacks.references = {{config.maximum_angle_of_attack_rad / degree, "the follower's cap"}};

  Section section{"tracking"};
  section.blocks.insert({{"speed", fmt::format("{:.2f}", config.cruise_speed_mps)},
                         {"worst", fmt::format("{:.2f}", worst)},
                         {"worst_moment", fmt::format("{:.2f}", worst_moment)}});
  section.pictures["tracking"] =
      to_svg({path, distance,
              panel("Roll, left wing down negative", "time (s)", "roll (deg)", time_s, roll_deg), attacks},
             2);
  section.checks = {at_most("follower on the real jog's path", worst, 0.40, "m")};
  return section;
}

}  // namespace understory
