#include "scenarios/flight/run_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>

#include "perception/io/hit_files.hpp"
#include "scenarios/flight/clearance.hpp"
#include "scenarios/output/file_output.hpp"
#include "scenarios/scenario/scenario_io.hpp"

namespace understory {
namespace {

/// The minimum true clearance is sampled at this fraction of the physics rate: 200 Hz, 6 cm of flight.
constexpr std::int64_t clearance_every_steps = 6;

constexpr const char* trajectory_header =
    "t_s,x_m,y_m,z_m,qw,qx,qy,qz,vx_world_mps,vy_world_mps,vz_world_mps,p_radps,q_radps,r_radps,"
    "est_x_m,est_y_m,est_z_m,est_qw,est_qx,est_qy,est_qz,est_vx_world_mps,est_vy_world_mps,est_vz_world_mps,"
    "est_p_radps,est_q_radps,est_r_radps,left_elevon_command_rad,right_elevon_command_rad,thrust_command_n,"
    "left_elevon_rad,right_elevon_rad,thrust_n,clearance_m\n";

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

std::span<const std::byte> bytes_of(const cv::Mat& image) {
  return std::as_bytes(std::span(image.data, image.total() * image.elemSize()));
}

}  // namespace

void prepare_run_folder(const Scenario& scenario, const std::filesystem::path& folder) {
  prepare_output_folder(folder);
  for (const char* file : {"result.json", "trajectory.csv", "map.ply", "flight.mp4", "still.png"}) {
    std::filesystem::remove(folder / file);  // of an earlier run: must not pass for this one's
  }
  write_whole_file(folder / "scenario.yaml", scenario_to_text(scenario));
}

RunRecord::RunRecord(const Scenario& scenario, std::vector<Obstacle> obstacles)
    : scenario_(scenario), obstacles_(std::move(obstacles)), trajectory_(trajectory_header) {
  result_.scenario = scenario.name;
  result_.seed = scenario.seed;
  result_.sensor_seed = scenario.sensor_seed();
  result_.detector = word_for(scenario.perception.detector);
  result_.state_source = word_for(scenario.estimation.source);
  result_.min_clearance_m = std::numeric_limits<double>::infinity();
}

void RunRecord::observe(const Truth& truth, bool released) {
  digest_.add(truth.T_world_body);
  if (released) {
    if (released_s_ > 0) {
      result_.distance_m +=
          (truth.T_world_body.translation() - last_truth_.T_world_body.translation()).norm();
    } else {
      released_s_ = static_cast<double>(truth.t_ns) * 1e-9;
    }
    result_.progress_m = std::max(result_.progress_m, truth.T_world_body.translation().x());
  }
  if (steps_++ % clearance_every_steps == 0) {
    result_.min_clearance_m = std::min(result_.min_clearance_m, clearance_at(truth));
  }
  last_truth_ = truth;
}

double RunRecord::clearance_at(const Truth& truth) {
  if (truth.t_ns != clearance_t_ns_) {
    clearance_t_ns_ = truth.t_ns;
    clearance_m_ = understory::clearance_m(truth.T_world_body, scenario_.airframe, obstacles_);
  }
  return clearance_m_;
}

void RunRecord::observe(const Truth& truth, const State& state, const Controls& controls, bool released) {
  digest_.add(state.T_world_body);
  digest_.add(controls.left_elevon_rad);
  digest_.add(controls.right_elevon_rad);
  digest_.add(controls.thrust_n);
  const Eigen::Vector3d velocity_world = state.T_world_body.linear() * state.velocity_body_mps;
  fmt::format_to(std::back_inserter(trajectory_), "{:.6f}", static_cast<double>(truth.t_ns) * 1e-9);
  append(trajectory_, truth.T_world_body, truth.velocity_world_mps, truth.angular_rate_body_radps);
  append(trajectory_, state.T_world_body, velocity_world, state.angular_rate_body_radps);
  fmt::format_to(std::back_inserter(trajectory_), ",{:.5f},{:.5f},{:.4f},{:.5f},{:.5f},{:.4f},{:.4f}\n",
                 controls.left_elevon_rad, controls.right_elevon_rad, controls.thrust_n,
                 truth.left_elevon_rad, truth.right_elevon_rad, truth.thrust_n, clearance_at(truth));
  if (!released) return;
  const double error_m = (state.T_world_body.translation() - truth.T_world_body.translation()).norm();
  const Eigen::AngleAxisd turn(
      Eigen::Matrix3d(state.T_world_body.linear().transpose() * truth.T_world_body.linear()));
  error_sum_m_ += error_m;
  velocity_error_sum_mps_ += (velocity_world - truth.velocity_world_mps).norm();
  error_count_ += 1;
  result_.position_error_max_m = std::max(result_.position_error_max_m, error_m);
  result_.position_error_end_m = error_m;
  result_.attitude_error_max_rad = std::max(result_.attitude_error_max_rad, std::abs(turn.angle()));
}

void RunRecord::observe(const StereoFrame& frame, std::size_t hit_count) {
  digest_.add(static_cast<std::uint64_t>(frame.t_ns));
  digest_.add(bytes_of(frame.left));
  digest_.add(bytes_of(frame.right));
  digest_.add(static_cast<std::uint64_t>(hit_count));
  result_.frames += 1;
  result_.detections += static_cast<std::int64_t>(hit_count);
}

void RunRecord::remember_of_frame(const std::vector<ObstaclePoint>& points, std::int64_t t_ns,
                                  const Eigen::Isometry3d& T_true_estimated) {
  for (const ObstaclePoint& point : points) {
    if (point.t_ns != t_ns || point.sightings != 1) continue;
    points_.push_back(point);
    true_positions_world_.push_back(T_true_estimated * point.position_world);
  }
  result_.remembered_points = static_cast<std::int64_t>(points_.size());
}

void RunRecord::finish(Ending ending) {
  result_.ending = ending;
  result_.simulated_s = static_cast<double>(last_truth_.t_ns) * 1e-9;
  const double flown_s = result_.simulated_s - released_s_;
  if (released_s_ > 0 && flown_s > 0) result_.mean_speed_mps = result_.distance_m / flown_s;
  if (error_count_ > 0) {
    result_.position_error_mean_m = error_sum_m_ / static_cast<double>(error_count_);
    result_.velocity_error_mean_mps = velocity_error_sum_mps_ / static_cast<double>(error_count_);
  }
  const double now_clearance = clearance_m(last_truth_.T_world_body, scenario_.airframe, obstacles_);
  result_.min_clearance_m = std::min(result_.min_clearance_m, now_clearance);
  if (ending == Ending::collision) {
    double minimum = std::numeric_limits<double>::infinity();
    for (const Obstacle& obstacle : obstacles_) {
      const double here = clearance_m(last_truth_.T_world_body, scenario_.airframe, {obstacle});
      if (here < minimum) result_.touched = obstacle.name;
      minimum = std::min(minimum, here);
    }
  }
  if (obstacles_.size() <= 8) {  // a course of few, named bars: say what was seen of each
    for (const Obstacle& bar : obstacles_) {
      const auto near = [&](const Eigen::Vector3d& point_world) {
        return obstacle_distance_m({point_world, point_world}, bar) < 0.5;
      };
      result_.points_on_obstacles.emplace_back(
          bar.name, std::count_if(true_positions_world_.begin(), true_positions_world_.end(), near));
    }
  }
  result_.digest = digest_.hex();
}

void RunRecord::write(const std::filesystem::path& folder) const {
  write_whole_file(folder / "trajectory.csv", trajectory_);
  write_whole_file(folder / "map.ply", points_to_ply(points_));
  write_whole_file(folder / "result.json", to_json(result_));
}

}  // namespace understory
