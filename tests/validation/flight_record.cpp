#include "tests/validation/flight_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

#include "scenarios/config/config_tree.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

constexpr std::size_t columns = 16;

RecordedMoment moment(const std::array<double, columns>& n) {
  const Eigen::Matrix3d attitude =
      (Eigen::AngleAxisd(n[6], Vector3d::UnitZ()) * Eigen::AngleAxisd(n[5], Vector3d::UnitY()) *
       Eigen::AngleAxisd(n[4], Vector3d::UnitX()))
          .toRotationMatrix();
  return {n[0],
          {n[1], n[2], n[3]},
          n[4],
          n[5],
          n[6],
          attitude,
          {n[7], n[8], n[9]},
          {n[13], n[14], n[15]},
          {n[10], n[11], n[12]}};
}

/// Trapezoids over the record's own velocities.
std::vector<Vector3d> integrated_velocity(const std::vector<RecordedMoment>& moments) {
  std::vector<Vector3d> positions{Vector3d::Zero()};
  for (std::size_t i = 1; i < moments.size(); ++i) {
    const Vector3d before = moments[i - 1].R_world_body * moments[i - 1].velocity_body_mps;
    const Vector3d after = moments[i].R_world_body * moments[i].velocity_body_mps;
    positions.push_back(positions.back() + 0.5 * (moments[i].t_s - moments[i - 1].t_s) * (before + after));
  }
  return positions;
}

}  // namespace

AirborneStart FlightRecord::start() const {
  const RecordedMoment& first = moments.front();
  return {first.R_world_body, first.velocity_body_mps, first.angular_rate_body_radps, first.controls};
}

FlightRecord read_flight_record(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream)
    throw ScenarioError(fmt::format("{}: cannot be read (the record of a real flight)", file.string()));
  FlightRecord record;
  int line_number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++line_number;
    if (line.empty() || line[0] == '#' || line[0] == 't') continue;
    std::istringstream cells(line);
    std::array<double, columns> numbers{};
    char comma = 0;
    for (std::size_t i = 0; i < columns; ++i) {
      cells >> numbers[i];
      if (i + 1 < columns) cells >> comma;
    }
    if (!cells || !(cells >> std::ws).eof())
      throw ScenarioError(fmt::format("{}:{}: expected {} numbers", file.string(), line_number, columns));
    record.moments.push_back(moment(numbers));
  }
  constexpr std::size_t minimum_moments = 2;
  if (record.moments.size() < minimum_moments)
    throw ScenarioError(fmt::format("{}: expected at least {} moments", file.string(), minimum_moments));
  const std::vector<Vector3d> integrated = integrated_velocity(record.moments);
  for (std::size_t i = 0; i < integrated.size(); ++i)
    record.moments[i].position_world.z() = integrated[i].z();
  return record;
}

double maximum_contradiction_m(const FlightRecord& record) {
  const std::vector<Vector3d> integrated = integrated_velocity(record.moments);
  double maximum = 0;
  for (std::size_t i = 0; i < integrated.size(); ++i)
    maximum = std::max(maximum, (record.moments[i].position_world - integrated[i]).head<2>().norm());
  return maximum;
}

}  // namespace understory
