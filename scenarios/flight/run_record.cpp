#include "scenarios/flight/run_record.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <span>

#include "perception/io/hit_files.hpp"
#include "scenarios/flight/clearance.hpp"
#include "scenarios/flight/flight.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/report/table.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

/// trajectory.csv and the minimum true clearance are sampled at 200 Hz, every 6 cm of flight.
constexpr std::int64_t row_every_steps = physics_rate_hz / 200;

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

/// A line of the TUM format: time, position, quaternion with its real part last.
void append_tum(std::string& text, double t_s, const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d& p = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  fmt::format_to(std::back_inserter(text), "{:.6f} {:.4f} {:.4f} {:.4f} {:.6f} {:.6f} {:.6f} {:.6f}\n", t_s,
                 p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
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

std::span<const std::byte> bytes_of(const cv::Mat& image) {
  return std::as_bytes(std::span(image.data, image.total() * image.elemSize()));
}

}  // namespace

const std::vector<std::string> run_patterns{"result.json",   "scenario.yaml", "trajectory.csv", "map.ply",
                                            "obstacles.csv", "truth.tum",     "estimate.tum",   "flight.mp4",
                                            "still.png",     "flight.mcap",   "report.html"};

FolderContents run_contents(const Scenario& scenario) {
  return {"flight", "scenario.yaml", scenario_to_text(scenario), run_patterns};
}

void RunRecord::on_frame(const Flight& flight) {
  const StereoFrame& frame = flight.frame();
  const std::size_t hits = flight.hits().size();
  digest_.add(static_cast<std::uint64_t>(frame.t_ns));
  // Images that are rendered for an observer alone must not change the digest.
  const bool detected_in = uses_images(flight.scenario().perception.detector);
  digest_.add(detected_in ? bytes_of(frame.left) : std::span<const std::byte>());
  digest_.add(detected_in ? bytes_of(frame.right) : std::span<const std::byte>());
  digest_.add(static_cast<std::uint64_t>(hits));
  result_.frames += 1;
  result_.detections += static_cast<std::int64_t>(hits);
  add_points(flight);
}

/// The points that this frame added to the map, without those it saw again. They are assigned to obstacles
/// from the true pose, because the odometry frame drifts.
void RunRecord::add_points(const Flight& flight) {
  const std::int64_t t_ns = flight.frame().t_ns;
  const Eigen::Isometry3d T_true_estimated =
      flight.truth_at(t_ns).T_world_body * flight.state_at(t_ns).T_world_body.inverse();
  for (const ObstaclePoint& point : flight.map().points()) {
    if (point.t_ns != t_ns || point.sightings != 1) continue;
    points_.push_back(point);
    true_positions_world_.push_back(T_true_estimated * point.position_world);
  }
  result_.remembered_points = static_cast<std::int64_t>(points_.size());
}

void RunRecord::on_step(const Flight& flight) {
  digest_.add(flight.truth().T_world_body);
  if (flight.launched()) add_path(flight);
  if (flight.clock().step() % row_every_steps == 0) add_row(flight);
}

void RunRecord::add_path(const Flight& flight) {
  const Eigen::Vector3d& position_world = flight.truth().T_world_body.translation();
  if (released_ns_) result_.distance_m += (position_world - last_position_world_).norm();
  if (!released_ns_) released_ns_ = flight.clock().t_ns();
  last_position_world_ = position_world;
  result_.progress_m = std::max(result_.progress_m, position_world.x());
}

/// Truth, estimate and controls side by side.
void RunRecord::add_row(const Flight& flight) {
  const Truth& truth = flight.truth();
  const State& state = flight.state();
  const Controls& controls = flight.controls();
  digest_.add(state.T_world_body);
  digest_.add(controls.left_elevon_rad);
  digest_.add(controls.right_elevon_rad);
  digest_.add(controls.thrust_n);
  const double clearance_now_m =
      clearance_m(truth.T_world_body, flight.scenario().airframe, flight.obstacles());
  result_.minimum_clearance_m = std::min(result_.minimum_clearance_m, clearance_now_m);
  fmt::format_to(std::back_inserter(trajectory_), "{:.6f}", flight.clock().t_s());
  append(trajectory_, truth.T_world_body, truth.velocity_world_mps, truth.angular_rate_body_radps);
  append(trajectory_, state.T_world_body, state.T_world_body.linear() * state.velocity_body_mps,
         state.angular_rate_body_radps);
  fmt::format_to(std::back_inserter(trajectory_), ",{:.5f},{:.5f},{:.4f},{:.5f},{:.5f},{:.4f},{:.4f}\n",
                 controls.left_elevon_rad, controls.right_elevon_rad, controls.thrust_n,
                 truth.left_elevon_rad, truth.right_elevon_rad, truth.thrust_n, clearance_now_m);
  append_tum(true_path_, flight.clock().t_s(), truth.T_world_body);
  append_tum(estimated_path_, flight.clock().t_s(), state.T_world_body);
  if (flight.launched()) add_errors(flight);
}

void RunRecord::add_errors(const Flight& flight) {
  const Truth& truth = flight.truth();
  const State& state = flight.state();
  const double error_m = (state.T_world_body.translation() - truth.T_world_body.translation()).norm();
  const Eigen::AngleAxisd turn(
      Eigen::Matrix3d(state.T_world_body.linear().transpose() * truth.T_world_body.linear()));
  position_error_sum_m_ += error_m;
  velocity_error_sum_mps_ +=
      (state.T_world_body.linear() * state.velocity_body_mps - truth.velocity_world_mps).norm();
  error_count_ += 1;
  result_.position_error_max_m = std::max(result_.position_error_max_m, error_m);
  result_.position_error_end_m = error_m;
  result_.attitude_error_max_rad = std::max(result_.attitude_error_max_rad, std::abs(turn.angle()));
}

FlightResult RunRecord::finish(const Flight& flight) {
  const Scenario& scenario = flight.scenario();
  result_.scenario = scenario.name;
  result_.seed = scenario.seed;
  result_.sensor_seed = scenario.sensor_seed();
  result_.detector = word_for(scenario.perception.detector);
  result_.state_source = word_for(scenario.estimation.source);
  result_.outcome = flight.outcome().value();
  result_.simulated_s = flight.clock().t_s();
  const double flown_s = released_ns_ ? result_.simulated_s - static_cast<double>(*released_ns_) * 1e-9 : 0;
  if (flown_s > 0) result_.mean_speed_mps = result_.distance_m / flown_s;
  if (error_count_ > 0) {
    result_.position_error_mean_m = position_error_sum_m_ / static_cast<double>(error_count_);
    result_.velocity_error_mean_mps = velocity_error_sum_mps_ / static_cast<double>(error_count_);
  }
  const double clearance_now_m =
      clearance_m(flight.truth().T_world_body, scenario.airframe, flight.obstacles());
  result_.minimum_clearance_m = std::min(result_.minimum_clearance_m, clearance_now_m);
  if (result_.outcome == Outcome::collision) {
    const auto touched = nearest_obstacle(flight.truth().T_world_body, scenario.airframe, flight.obstacles());
    if (touched) result_.touched = flight.obstacles()[*touched].name;
  }
  if (flight.obstacles().size() <= 8) count_points_on_obstacles(flight.obstacles());
  result_.planner = flight.planner_counts();
  if (flight.cameras() != nullptr) result_.renderer = flight.cameras()->renderer();
  result_.timings = flight.stopwatch().timings();
  result_.wall_s = flight.stopwatch().elapsed_s();
  result_.digest = digest_.hex();
  obstacles_ = obstacles_csv(flight.obstacles());
  return result_;
}

/// On a course of few named obstacles: the points seen on each.
void RunRecord::count_points_on_obstacles(const std::vector<Obstacle>& obstacles) {
  for (const Obstacle& obstacle : obstacles) {
    const auto near = [&](const Eigen::Vector3d& point_world) { return belongs_to(point_world, obstacle); };
    result_.points_on_obstacles.emplace_back(obstacle.name,
                                             std::ranges::count_if(true_positions_world_, near));
  }
}

void RunRecord::write(const std::filesystem::path& folder) const {
  write_whole_file(folder / "trajectory.csv", std::string(trajectory_columns) + trajectory_);
  write_whole_file(folder / "map.ply", points_to_ply(points_));
  write_whole_file(folder / "obstacles.csv", obstacles_);
  write_whole_file(folder / "truth.tum", true_path_);
  write_whole_file(folder / "estimate.tum", estimated_path_);
  write_whole_file(folder / "result.json", to_json(result_));
}

}  // namespace understory
