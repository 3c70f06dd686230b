#include "planning/manoeuvre_improvement.hpp"

#include <algorithm>
#include <limits>
#include <random>

namespace understory {
namespace {

constexpr double minimum_part_s = 0.04;
constexpr double maximum_part_s = 1.0;
constexpr double climb_limit_mps = 3.0;

}  // namespace

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

}  // namespace understory
