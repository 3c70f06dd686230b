#include "planning/manoeuvre.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace understory {
namespace {

constexpr double maximum_rollout_s = 4.0;
constexpr double side_margin_m = 6.0;  // the course guidance turns inwards this far from the sides

double square(double value) { return value * value; }

PlanPoint plan_point(const FlightState& state, const FlightCommand& command, double t_s) {
  return {t_s,
          state.position_world,
          state.speed_mps,
          state.heading_rad,
          state.climb_angle_rad,
          state.bank_rad,
          state.angle_of_attack_rad,
          command.bank_rad,
          command.climb_mps};
}

double cross_track_m(const FlightTask& task, const Eigen::Vector3d& position_world) {
  return -task.ahead.y() * position_world.x() + task.ahead.x() * position_world.y();
}

/// Beyond this factor a squared distance is larger even after rounding, so no root is needed.
double no_less_than(double distance) { return distance * distance * (1 + 1e-12); }

template <typename Ranked>
bool is_nearer(const Ranked& one, const Ranked& other) {
  return one.first < other.first;
}

constexpr double minimum_part_s = 0.04;
constexpr double maximum_part_s = 1.0;
constexpr double climb_limit_mps = 3.0;

}  // namespace

double progress_m(const FlightTask& task, const Eigen::Vector3d& position_world) {
  const Eigen::Vector3d flown = position_world - task.origin_world;
  return task.ahead.x() * flown.x() + task.ahead.y() * flown.y();
}

double band_clearance_m(const FlightTask& task, const FlightState& state) {
  const double altitude = state.position_world.z();
  return std::min(altitude - task.mission.minimum_altitude_m, task.mission.maximum_altitude_m - altitude);
}

FlightCommand course_command(const FlightTask& task, const FlightState& state) {
  const TrajectoryConfig& config = task.config;
  const double cross_m = cross_track_m(task, state.position_world);
  const double beyond_m = std::max(0.0, std::abs(cross_m) - (task.mission.half_width_m - side_margin_m));
  const double heading = task.mission.heading_rad - std::copysign(std::min(0.6, 0.12 * beyond_m), cross_m);
  FlightCommand command;
  command.bank_rad = std::clamp(config.heading_gain * (course_rad(state) - heading),
                                -config.maximum_course_bank_rad, config.maximum_course_bank_rad);
  command.climb_mps =
      std::clamp(config.altitude_gain_per_s * (task.mission.cruise_altitude_m - state.position_world.z()),
                 -config.maximum_climb_mps, config.maximum_climb_mps);
  return command;
}

double cost_rate(const FlightTask& task, const FlightState& state, double clearance_m) {
  const TrajectoryConfig& config = task.config;
  const Mission& mission = task.mission;
  const double altitude = state.position_world.z();
  const double below = std::max(0.0, mission.minimum_altitude_m + config.band_margin_m - altitude);
  const double above = std::max(0.0, altitude - (mission.maximum_altitude_m - config.band_margin_m));
  const double beside = std::max(
      0.0, std::abs(cross_track_m(task, state.position_world)) - (mission.half_width_m - side_margin_m));
  const double near = std::max(0.0, 1 - clearance_m / config.comfortable_clearance_m);
  const double slow = std::max(0.0, task.model.config().cruise_speed_mps - 1 - state.speed_mps);
  return 1 + config.clearance_weight * square(near) + config.bank_weight * square(state.bank_rad) +
         config.heading_weight * square(course_rad(state) - mission.heading_rad) +
         config.altitude_weight * square(altitude - mission.cruise_altitude_m) +
         config.band_weight * (square(below) + square(above)) + square(beside) +
         config.slow_weight * square(slow);
}

double maximum_clearance_m(const TrajectoryConfig& config, double minimum_clearance_m) {
  return std::max(config.comfortable_clearance_m, minimum_clearance_m);
}

double final_cost(const FlightTask& task, const FlightState& state) {
  return task.config.final_heading_weight * square(course_rad(state) - task.mission.heading_rad) +
         task.config.bank_weight * square(state.bank_rad);
}

double least_cost_to_go(const FlightTask& task, const FlightState& state) {
  const double airspeed_mps = std::max(state.speed_mps, task.model.config().cruise_speed_mps);
  const double to_go_m = task.config.horizon_m - progress_m(task, state.position_world);
  return std::max(0.0, to_go_m) / (1.5 * airspeed_mps + state.wind_world_mps.norm());
}

Rollout fly_out(const FlightTask& task, const FlightState& start, const Manoeuvre& manoeuvre,
                double minimum_clearance_m, bool keep_points, bool stop_when_too_near, double maximum_cost) {
  Rollout rollout;
  FlightState state = start;
  const double step_s = task.config.step_s;
  const double maximum_m = maximum_clearance_m(task.config, minimum_clearance_m);
  std::size_t part = 0;
  double part_left_s = manoeuvre.empty() ? 0 : manoeuvre.front().duration_s;
  bool too_near = false;
  for (double t_s = 0; t_s < maximum_rollout_s; t_s += step_s) {
    while (part < manoeuvre.size() && part_left_s < 0.5 * step_s)
      if (++part < manoeuvre.size()) part_left_s += manoeuvre[part].duration_s;
    const bool in_manoeuvre = part < manoeuvre.size();
    const FlightCommand command = in_manoeuvre ? manoeuvre[part].command : course_command(task, state);
    if (in_manoeuvre) part_left_s -= step_s;
    if (keep_points) rollout.points.push_back(plan_point(state, command, t_s));
    state = task.model.advance(state, command, step_s);
    if (task.steps != nullptr) ++*task.steps;
    const double clearance = task.field.clearance_m(state, maximum_m);
    rollout.minimum_clearance_m = std::min(rollout.minimum_clearance_m, clearance);
    rollout.cost += step_s * cost_rate(task, state, clearance);
    const double margin = std::min(clearance, band_clearance_m(task, state));
    rollout.minimum_margin_m = std::min(rollout.minimum_margin_m, margin);
    too_near = too_near || margin < minimum_clearance_m;
    if (!too_near) rollout.free_until_s = t_s + step_s;
    if (too_near && stop_when_too_near) break;
    if (rollout.cost + least_cost_to_go(task, state) > maximum_cost) break;
    if (progress_m(task, state.position_world) >= task.config.horizon_m) {
      rollout.reached_horizon = !too_near;
      break;
    }
  }
  rollout.cost += final_cost(task, state);
  if (keep_points)
    rollout.points.push_back(plan_point(state, course_command(task, state),
                                        task.config.step_s * static_cast<double>(rollout.points.size())));
  return rollout;
}

ImprovedManoeuvre improve_manoeuvre(const FlightTask& task, const FlightState& start,
                                    const Manoeuvre& manoeuvre, double minimum_clearance_m,
                                    const ManoeuvreImprovementConfig& config, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> gaussian;
  const auto cost_of = [&](const Manoeuvre& candidate, double maximum_cost) {
    const Rollout rollout = fly_out(task, start, candidate, minimum_clearance_m, false, true, maximum_cost);
    return rollout.reached_horizon ? rollout.cost : std::numeric_limits<double>::infinity();
  };
  ImprovedManoeuvre best{manoeuvre, cost_of(manoeuvre, std::numeric_limits<double>::infinity())};
  if (manoeuvre.empty()) return best;
  for (int iteration = 0; iteration < config.iterations; ++iteration) {
    Manoeuvre candidate = best.manoeuvre;
    ManoeuvrePart& part = candidate[generator() % candidate.size()];
    part.command.bank_rad = std::clamp(part.command.bank_rad + config.bank_sigma_rad * gaussian(generator),
                                       -config.maximum_bank_rad, config.maximum_bank_rad);
    part.command.climb_mps = std::clamp(part.command.climb_mps + config.climb_sigma_mps * gaussian(generator),
                                        -climb_limit_mps, climb_limit_mps);
    part.duration_s = std::clamp(part.duration_s + config.duration_sigma_s * gaussian(generator),
                                 minimum_part_s, maximum_part_s);
    const double cost = cost_of(candidate, best.cost);
    if (cost < best.cost) best = {std::move(candidate), cost};
  }
  return best;
}

Manoeuvre rest_of(const Manoeuvre& manoeuvre, double elapsed_s) {
  Manoeuvre left;
  for (ManoeuvrePart part : manoeuvre) {
    const double used_s = std::min(elapsed_s, part.duration_s);
    elapsed_s -= used_s;
    part.duration_s -= used_s;
    if (part.duration_s > 1e-3) left.push_back(part);
  }
  return left;
}

std::vector<Manoeuvre> avoidance_primitives(double maximum_bank_rad) {
  std::vector<Manoeuvre> primitives{{}};
  for (const double share : {0.2, 0.4, 0.6, 0.8, 1.0})
    for (const double side : {-1.0, 1.0})
      for (const double first_s : {0.3, 0.6, 1.0}) {
        const double bank = side * share * maximum_bank_rad;
        primitives.push_back({{{bank, 0.5}, first_s}});
        primitives.push_back({{{bank, 0.5}, first_s}, {{-bank, 0.5}, 0.7 * first_s}});
      }
  return primitives;
}

bool is_near(const ObstaclePoint& point, const Plan& plan, const PlannerConfig& config) {
  const ObstacleFieldConfig& field = config.field;
  const double near_m = config.trajectory.comfortable_clearance_m + field.half_span_m + field.wing_radius_m +
                        field.sigma_zero_m + 0.5 * field.cell_m;
  return std::ranges::any_of(plan.points, [&](const PlanPoint& planned) {
    return (planned.position_world - point.position_world).head<2>().squaredNorm() <= near_m * near_m;
  });
}

std::size_t FlightPlaces::nearest(const FlightPlace& place) const {
  std::size_t best = 0;
  double minimum = std::sqrt(squared_distance(places_.front(), place)), enough = no_less_than(minimum);
  for (std::size_t i = 1; i < places_.size(); ++i) {
    const double squared = squared_distance(places_[i], place);
    if (squared > enough) continue;
    if (const double distance = std::sqrt(squared); distance < minimum)
      best = i, minimum = distance, enough = no_less_than(minimum);
  }
  return best;
}

std::vector<std::size_t> FlightPlaces::nearest(const FlightPlace& place, std::size_t count) const {
  if (count == 1 && !places_.empty()) return {nearest(place)};  // what SST asks for
  ranked_.clear();
  for (std::size_t i = 0; i < places_.size(); ++i)
    ranked_.emplace_back(std::sqrt(squared_distance(places_[i], place)), i);
  count = std::min(count, ranked_.size());
  if (count < ranked_.size()) {
    std::partial_sort(ranked_.begin(), ranked_.begin() + static_cast<std::ptrdiff_t>(count), ranked_.end(),
                      is_nearer<Ranked>);
    ranked_.resize(count);
  } else {
    std::sort(ranked_.begin(), ranked_.end(), is_nearer<Ranked>);
  }
  return numbers();
}

std::vector<std::size_t> FlightPlaces::within(const FlightPlace& place, double radius) const {
  const double enough = no_less_than(radius);
  ranked_.clear();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const double squared = squared_distance(places_[i], place);
    if (squared > enough) continue;
    if (const double distance = std::sqrt(squared); distance <= radius) ranked_.emplace_back(distance, i);
  }
  std::sort(ranked_.begin(), ranked_.end(), is_nearer<Ranked>);
  return numbers();
}

std::vector<std::size_t> FlightPlaces::numbers() const {
  std::vector<std::size_t> numbers;
  for (const auto& [distance, number] : ranked_) numbers.push_back(number);
  return numbers;
}

}  // namespace understory
