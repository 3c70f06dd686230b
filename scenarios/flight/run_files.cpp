#include "scenarios/flight/run_files.hpp"

#include <fmt/core.h>

#include <iterator>

#include "perception/io/hit_files.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/report/table.hpp"

namespace understory {

namespace {

constexpr std::int64_t row_every_ns = 5'000'000;

void append(std::string& text, const Eigen::Isometry3d& pose, const Eigen::Vector3d& velocity_world_mps,
            const Eigen::Vector3d& angular_rate_body_radps) {
  const Eigen::Vector3d& p = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d& v = velocity_world_mps;
  const Eigen::Vector3d& w = angular_rate_body_radps;
  fmt::format_to(std::back_inserter(text), ",{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{:.6f}", p.x(), p.y(),
                 p.z(), q.w(), q.x(), q.y(), q.z());
  fmt::format_to(std::back_inserter(text), ",{:.4f},{:.4f},{:.4f},{:.5f},{:.5f},{:.5f}", v.x(), v.y(), v.z(),
                 w.x(), w.y(), w.z());
}

/// The last moment of a flight may lie between two rows.
bool is_row(const LogMoment& moment) { return moment.t_ns % row_every_ns == 0; }

std::string trajectory_csv(const FlightLog& log) {
  std::string text = trajectory_columns;
  for (const LogMoment& moment : log.moments) {
    if (!is_row(moment)) continue;
    fmt::format_to(std::back_inserter(text), "{:.6f}", seconds(moment.t_ns));
    append(text, moment.T_world_body, moment.velocity_world_mps, moment.angular_rate_body_radps);
    append(text, moment.T_odometry_body, moment.estimated_velocity_mps, moment.estimated_rate_body_radps);
    const Controls& controls = moment.controls;
    fmt::format_to(std::back_inserter(text), ",{:.5f},{:.5f},{:.4f},{:.5f},{:.5f},{:.4f},{:.4f}\n",
                   controls.left_elevon_rad, controls.right_elevon_rad, controls.thrust_n,
                   moment.left_elevon_rad, moment.right_elevon_rad, moment.thrust_n, moment.clearance_m);
  }
  return text;
}

/// Lines of the TUM format: time, position, quaternion with its real part last.
std::string tum(const FlightLog& log, Eigen::Isometry3d LogMoment::*pose_of) {
  std::string text;
  for (const LogMoment& moment : log.moments) {
    if (!is_row(moment)) continue;
    const Eigen::Vector3d& p = (moment.*pose_of).translation();
    const Eigen::Quaterniond q((moment.*pose_of).linear());
    fmt::format_to(std::back_inserter(text), "{:.6f} {:.4f} {:.4f} {:.4f} {:.6f} {:.6f} {:.6f} {:.6f}\n",
                   seconds(moment.t_ns), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

std::string obstacles_csv(const std::vector<Obstacle>& obstacles) {
  Table table{{"name", "kind", "from_x_m", "from_y_m", "from_z_m", "to_x_m", "to_y_m", "to_z_m", "radius_m"}};
  for (const Obstacle& obstacle : obstacles) {
    table.rows.push_back({obstacle.name, std::string(word_for(obstacle.kind))});
    for (const Eigen::Vector3d& end : {obstacle.from_world, obstacle.to_world})
      for (const double coordinate : end) table.rows.back().push_back(number_text(coordinate, 3));
    table.rows.back().push_back(number_text(obstacle.radius_m, 3));
  }
  return to_csv(table);
}

/// Every point that was ever taken into the map, where it was seen first.
std::string map_ply(const FlightLog& log) {
  std::vector<ObstaclePoint> points;
  for (const LogPoint& one : log.points)
    if (one.point.sightings == 1) points.push_back(one.point);
  return points_to_ply(points);
}

}  // namespace

void write_run_files(const FlightLog& log, const std::filesystem::path& folder) {
  write_whole_file(folder / "trajectory.csv", trajectory_csv(log));
  write_whole_file(folder / "map.ply", map_ply(log));
  write_whole_file(folder / "obstacles.csv", obstacles_csv(log.obstacles));
  write_whole_file(folder / "truth.tum", tum(log, &LogMoment::T_world_body));
  write_whole_file(folder / "estimate.tum", tum(log, &LogMoment::T_odometry_body));
  write_whole_file(folder / "flight.log", to_bytes(log));
  write_whole_file(folder / "result.json", to_json(log.result));
}

}  // namespace understory
