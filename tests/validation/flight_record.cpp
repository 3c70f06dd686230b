#include "tests/validation/flight_record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "perception/assertion.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

/// t, position, roll, pitch, yaw, velocity, controls, rate.
using RecordedLine = std::array<double, 16>;

FlightMoment moment(const RecordedLine& n) {
  const Eigen::Matrix3d attitude =
      (Eigen::AngleAxisd(n[6], Vector3d::UnitZ()) * Eigen::AngleAxisd(n[5], Vector3d::UnitY()) *
       Eigen::AngleAxisd(n[4], Vector3d::UnitX()))
          .toRotationMatrix();
  return {
      n[0], {n[1], n[2], n[3]}, attitude, {n[7], n[8], n[9]}, {n[13], n[14], n[15]}, {n[10], n[11], n[12]}};
}

/// Trapezoids over the record's own velocities.
std::vector<Vector3d> integrated_velocity(const FlightRecord& record) {
  std::vector<Vector3d> positions{Vector3d::Zero()};
  for (std::size_t i = 1; i < record.size(); ++i) {
    const Vector3d before = record[i - 1].R_world_body * record[i - 1].velocity_body_mps;
    const Vector3d after = record[i].R_world_body * record[i].velocity_body_mps;
    positions.push_back(positions.back() + 0.5 * (record[i].t_s - record[i - 1].t_s) * (before + after));
  }
  return positions;
}

}  // namespace

double FlightMoment::roll_rad() const { return std::atan2(R_world_body(2, 1), R_world_body(2, 2)); }
double FlightMoment::pitch_rad() const { return std::asin(-R_world_body(2, 0)); }
double FlightMoment::yaw_rad() const { return std::atan2(R_world_body(1, 0), R_world_body(0, 0)); }

FlightRecord real_left_jog() {
  std::ifstream stream(UNDERSTORY_SOURCE_DIR "/tests/data/flight/left_jog.csv");
  FlightRecord record;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line[0] == '#' || line[0] == 't') continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream cells(line);
    RecordedLine numbers{};
    for (double& number : numbers) cells >> number;
    assert_always(!cells.fail(), "the record of the left jog has 16 numbers a line");
    record.push_back(moment(numbers));
  }
  assert_always(!record.empty(), "the record of the left jog can be read");
  const std::vector<Vector3d> integrated = integrated_velocity(record);
  for (std::size_t i = 0; i < integrated.size(); ++i) record[i].position_world.z() = integrated[i].z();
  return record;
}

double maximum_contradiction_m(const FlightRecord& record) {
  const std::vector<Vector3d> integrated = integrated_velocity(record);
  double maximum = 0;
  for (std::size_t i = 0; i < integrated.size(); ++i)
    maximum = std::max(maximum, (record[i].position_world - integrated[i]).head<2>().norm());
  return maximum;
}

AirborneStart start_of(const FlightRecord& record) {
  const FlightMoment& first = record.front();
  return {first.R_world_body, first.velocity_body_mps, first.angular_rate_body_radps, first.controls};
}

FlightMoment moment_of(const Truth& truth, double t_s) {
  const Eigen::Matrix3d attitude = truth.T_world_body.linear();
  return {t_s,
          truth.T_world_body.translation() - Vector3d(0, 0, start_altitude_m),
          attitude,
          attitude.transpose() * truth.velocity_world_mps,
          truth.angular_rate_body_radps,
          {}};
}

FlightRecord replay(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record) {
  Aircraft aircraft = air.begin(airframe, start_of(record));
  FlightRecord flown{moment_of(aircraft.truth(), 0)};
  std::int64_t step = 0;
  for (std::size_t i = 0; i + 1 < record.size(); ++i) {
    const double until_s = record[i + 1].t_s - record[0].t_s;
    for (; step < std::llround(until_s * physics_rate_hz); ++step) aircraft.step(record[i].controls);
    flown.push_back(moment_of(aircraft.truth(), record[i + 1].t_s));
  }
  return flown;
}

std::vector<ReplayError> errors(const FlightRecord& flown, const FlightRecord& record) {
  std::vector<ReplayError> all;
  for (std::size_t i = 0; i < flown.size(); ++i) {
    const Vector3d offset = flown[i].position_world - record[i].position_world;
    const double roll = std::remainder(flown[i].roll_rad() - record[i].roll_rad(), 2 * std::numbers::pi);
    all.push_back({record[i].t_s, offset.head<2>().norm(), offset.z(), roll});
  }
  return all;
}

double rms_roll_rad(const std::vector<ReplayError>& all) {
  double sum = 0;
  for (const ReplayError& error : all) sum += error.roll_rad * error.roll_rad;
  return std::sqrt(sum / static_cast<double>(all.size()));
}

double maximum_m(const std::vector<ReplayError>& all, double ReplayError::*member) {
  double maximum = 0;
  for (const ReplayError& error : all) maximum = std::max(maximum, std::abs(error.*member));
  return maximum;
}

const ReplayError& error_at(const std::vector<ReplayError>& all, double t_s) {
  return *std::min_element(all.begin(), all.end(), [t_s](const ReplayError& a, const ReplayError& b) {
    return std::abs(a.t_s - t_s) < std::abs(b.t_s - t_s);
  });
}

}  // namespace understory
