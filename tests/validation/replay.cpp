#include "tests/validation/replay.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understory {
namespace {

double roll_of(const Eigen::Matrix3d& R_world_body) {
  return std::atan2(R_world_body(2, 1), R_world_body(2, 2));
}
double pitch_of(const Eigen::Matrix3d& R_world_body) { return std::asin(-R_world_body(2, 0)); }
double yaw_of(const Eigen::Matrix3d& R_world_body) {
  return std::atan2(R_world_body(1, 0), R_world_body(0, 0));
}

/// To within half a turn of zero.
double wrapped(double angle_rad) { return std::remainder(angle_rad, 2 * std::numbers::pi); }

}  // namespace

ReplayedMoment replayed_moment(const Truth& truth, double t_s) {
  ReplayedMoment moment;
  moment.t_s = t_s;
  moment.position_world = truth.T_world_body.translation() - Eigen::Vector3d(0, 0, start_altitude_m);
  moment.R_world_body = truth.T_world_body.linear();
  moment.velocity_body_mps = moment.R_world_body.transpose() * truth.velocity_world_mps;
  return moment;
}

Replay replay(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record) {
  Aircraft aircraft = air.begin(airframe, record.start());
  Replay flown{replayed_moment(aircraft.truth(), 0)};
  std::int64_t step = 0;
  for (std::size_t i = 0; i + 1 < record.moments.size(); ++i) {
    const double until_s = record.moments[i + 1].t_s - record.moments[0].t_s;
    for (; step < std::llround(until_s * physics_rate_hz); ++step) aircraft.step(record.moments[i].controls);
    flown.push_back(replayed_moment(aircraft.truth(), record.moments[i + 1].t_s));
  }
  return flown;
}

std::vector<ReplayError> errors(const Replay& flown, const FlightRecord& record) {
  std::vector<ReplayError> all;
  for (std::size_t i = 0; i < flown.size(); ++i) {
    const RecordedMoment& real = record.moments[i];
    const Eigen::Vector3d offset = flown[i].position_world - real.position_world;
    const Eigen::Matrix3d& attitude = flown[i].R_world_body;
    all.push_back({real.t_s, offset.head<2>().norm(), offset.z(), wrapped(roll_of(attitude) - real.roll_rad),
                   pitch_of(attitude) - real.pitch_rad, wrapped(yaw_of(attitude) - real.yaw_rad)});
  }
  return all;
}

double rms_roll_rad(const std::vector<ReplayError>& all) {
  double sum = 0;
  for (const ReplayError& error : all) sum += error.roll_rad * error.roll_rad;
  return std::sqrt(sum / static_cast<double>(all.size()));
}

double maximum_horizontal_m(const std::vector<ReplayError>& all) {
  double maximum = 0;
  for (const ReplayError& error : all) maximum = std::max(maximum, error.horizontal_m);
  return maximum;
}

double maximum_height_m(const std::vector<ReplayError>& all) {
  double maximum = 0;
  for (const ReplayError& error : all) maximum = std::max(maximum, std::abs(error.height_m));
  return maximum;
}

const ReplayError& error_at(const std::vector<ReplayError>& all, double t_s) {
  return *std::min_element(all.begin(), all.end(), [t_s](const ReplayError& a, const ReplayError& b) {
    return std::abs(a.t_s - t_s) < std::abs(b.t_s - t_s);
  });
}

}  // namespace understory
