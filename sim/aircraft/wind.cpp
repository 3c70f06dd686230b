#include "sim/aircraft/wind.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understory {
namespace {

constexpr double foot_m = 0.3048;

}  // namespace

DrydenScales low_altitude_dryden(double altitude_m, double wind20_mps) {
  const double height_ft = std::clamp(altitude_m / foot_m, 10.0, 1000.0);
  const double level = 0.177 + 0.000823 * height_ft;
  const double horizontal_m = height_ft / std::pow(level, 1.2) * foot_m;
  const double vertical_mps = 0.1 * wind20_mps;
  const double horizontal_mps = vertical_mps / std::pow(level, 0.4);
  return {{horizontal_m, horizontal_m, height_ft * foot_m}, {horizontal_mps, horizontal_mps, vertical_mps}};
}

DrydenTurbulence::DrydenTurbulence(std::uint64_t seed) : generator_(seed) {
  along_ = draw();
  for (Cascade* state : {&across_, &up_}) {  // stationary covariance [1/2 1/4; 1/4 1/4]
    const double first = draw(), second = draw();
    state->first = std::sqrt(0.5) * first;
    state->second = 0.5 * (std::sqrt(0.5) * first + std::sqrt(0.5) * second);
  }
}

void DrydenTurbulence::advance(double distance_m, const Eigen::Vector3d& length_m) {
  const double kept = std::exp(-distance_m / length_m.x());
  along_ = kept * along_ + std::sqrt(1 - kept * kept) * draw();
  advance(across_, distance_m / length_m.y());
  advance(up_, distance_m / length_m.z());
}

/// d first = -first + n, d second = -second + first over a step d of lengths: the transition is exp(-d) [1 0;
/// d 1], the noise's covariance the integral of exp(-2s) [1 s; s s^2], here by its Cholesky factor. For steps
/// below 1e-4 lengths the last pivot is lost in rounding and is clamped to zero; it is then millions of times
/// smaller than the contribution of `first`.
void DrydenTurbulence::advance(Cascade& state, double lengths) {
  const double kept = std::exp(-lengths);
  const double kept_twice = kept * kept;
  const double q11 = (1 - kept_twice) / 2;
  const double q12 = (1 - kept_twice * (1 + 2 * lengths)) / 4;
  const double q22 = (1 - kept_twice * (1 + 2 * lengths + 2 * lengths * lengths)) / 4;
  const double one = draw(), other = draw();
  const double pivot = std::sqrt(q11);
  const double below = pivot > 0 ? q12 / pivot : 0;
  const double second = kept * (state.second + lengths * state.first);
  state.first = kept * state.first + pivot * one;
  state.second = second + below * one + std::sqrt(std::max(0.0, q22 - below * below)) * other;
}

/// (1 + sqrt(3) s) / (1 + s)^2 read off the cascade: s / (1 + s)^2 is first - second.
Eigen::Vector3d DrydenTurbulence::unit_gust() const {
  const auto shaped = [](const Cascade& state) {
    return state.second + std::numbers::sqrt3 * (state.first - state.second);
  };
  return {along_, shaped(across_), shaped(up_)};
}

Wind::Wind(const Eigen::Vector3d& mean_world_mps) : Wind(mean_world_mps, {}, {}, 0) {}

Wind::Wind(const Eigen::Vector3d& mean_world_mps, const WindConfig& config, const ForestStand& stand,
           std::uint64_t seed)
    : mean_world_mps_(mean_world_mps), config_(config), stand_(stand), turbulence_(seed) {}

void Wind::advance(std::int64_t t_ns, double step_s, const Eigen::Vector3d& position_world,
                   const Eigen::Vector3d& velocity_world_mps) {
  const double altitude_m = position_world.z();
  const Eigen::Vector3d mean_world_mps = shelter_at(position_world) * mean_at(altitude_m);
  const double distance_m = step_s * (velocity_world_mps - mean_world_mps).norm();
  if (config_.turbulence_wind20_mps > 0) {
    turbulence_.advance(distance_m, low_altitude_dryden(altitude_m, 0).length_m);
  }
  if (t_ns > std::llround(1e9 * config_.gust.start_s)) into_gust_m_ += distance_m;
}

Eigen::Vector3d Wind::at(const Eigen::Vector3d& position_world) const {
  const double altitude_m = position_world.z();
  const double built_up = std::min(1.0, into_gust_m_ / config_.gust.length_m);
  const Eigen::Vector3d gust_world_mps =
      0.5 * (1 - std::cos(std::numbers::pi * built_up)) * config_.gust.amplitude_world_mps;
  return shelter_at(position_world) * (mean_at(altitude_m) + turbulence_at(altitude_m) + gust_world_mps);
}

Eigen::Vector3d Wind::mean_at(double altitude_m) const {
  if (config_.roughness_m == 0) return mean_world_mps_;
  constexpr double minimum_height_m = 0.9144;  // 3 ft: the profile is not given below
  const double height_m = std::max(altitude_m, minimum_height_m);
  const double share =
      std::log(height_m / config_.roughness_m) / std::log(config_.reference_height_m / config_.roughness_m);
  return std::max(0.0, share) * mean_world_mps_;
}

double Wind::shelter_at(const Eigen::Vector3d& position_world) const {
  if (position_world.z() > stand_.canopy_top_m) return 1;
  const double inside_m = std::min({position_world.x() - stand_.from_x_m, stand_.to_x_m - position_world.x(),
                                    stand_.half_width_m - std::abs(position_world.y())});
  const double grown = std::clamp(inside_m / config_.shelter_edge_m, 0.0, 1.0);
  return 1 + grown * (config_.shelter_factor - 1);
}

/// Turned from the mean wind's axes into the world's; without a mean wind along the world's own.
Eigen::Vector3d Wind::turbulence_at(double altitude_m) const {
  if (config_.turbulence_wind20_mps == 0) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d gust = turbulence_.unit_gust().cwiseProduct(
      low_altitude_dryden(altitude_m, config_.turbulence_wind20_mps).sigma_mps);
  const double horizontal_mps = mean_world_mps_.head<2>().norm();
  if (horizontal_mps == 0) return gust;
  const Eigen::Vector2d along = mean_world_mps_.head<2>() / horizontal_mps;
  return {along.x() * gust.x() - along.y() * gust.y(), along.y() * gust.x() + along.x() * gust.y(), gust.z()};
}

}  // namespace understory
