#include "tests/validation/replay_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/validation/damped_least_squares.hpp"

namespace understory {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double maximum_log = 1.5;
constexpr int channels = 4;

/// Channel by channel for each sample.
VectorXd residuals(const Replay& flown, const FlightRecord& record, double from_s, double until_s) {
  constexpr double horizontal_m = 0.20, height_m = 0.35, roll_rad = 4 * std::numbers::pi / 180;
  const std::vector<ReplayError> all = errors(flown, record);
  std::vector<double> numbers;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i].t_s < from_s - 1e-9 || all[i].t_s > until_s + 1e-9) continue;
    const Eigen::Vector3d offset = flown[i].position_world - record.moments[i].position_world;
    numbers.insert(numbers.end(), {offset.x() / horizontal_m, offset.y() / horizontal_m,
                                   offset.z() / height_m, all[i].roll_rad / roll_rad});
  }
  return Eigen::Map<VectorXd>(numbers.data(), static_cast<Index>(numbers.size()));
}

/// How many successive samples hold what one independent sample would, the channels taken together.
double memory_of(const VectorXd& residual) {
  double products = 0, squares = 0;
  for (Index i = channels; i < residual.size(); ++i) {
    products += residual[i] * residual[i - channels];
    squares += 0.5 * (residual[i] * residual[i] + residual[i - channels] * residual[i - channels]);
  }
  const double correlation = std::clamp(products / squares, 0.0, 0.999);
  return (1 + correlation) / (1 - correlation);
}

Airframe with(Airframe airframe, const std::vector<const FreeParameter*>& chosen, const VectorXd& logs) {
  for (std::size_t i = 0; i < chosen.size(); ++i)
    chosen[i]->in(airframe) *= std::exp(logs[static_cast<Index>(i)]);
  return airframe;
}

bool at_the_edge(double log) { return std::abs(log) > 0.99 * maximum_log; }

}  // namespace

const std::vector<FreeParameter>& free_parameters() {
  static const std::vector<FreeParameter> all{
      {"roll damping", "N m s/rad",
       [](Airframe& airframe) -> double& { return airframe.rate_damping_nmspr.x(); }},
      {"pitch damping", "N m s/rad",
       [](Airframe& airframe) -> double& { return airframe.rate_damping_nmspr.y(); }},
      {"elevon lift factor", "", [](Airframe& airframe) -> double& { return airframe.elevon_lift_factor; }}};
  return all;
}

ReplayFit fit_replay(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record,
                     const std::vector<const FreeParameter*>& chosen, double from_s, double until_s) {
  const Index count = static_cast<Index>(chosen.size());
  // Beyond the edge the replay says what it says at the edge: a parameter that runs there has no slope left,
  // and so no certainty.
  const auto residuals_at = [&](const VectorXd& logs) {
    const VectorXd inside = logs.cwiseMax(-maximum_log).cwiseMin(maximum_log);
    return residuals(replay(air, with(airframe, chosen, inside), record), record, from_s, until_s);
  };
  const LeastSquares best =
      least_squares(residuals_at, VectorXd::Zero(count), VectorXd::Constant(count, 1e-3));
  const VectorXd logs = best.parameters.cwiseMax(-maximum_log).cwiseMin(maximum_log);

  ReplayFit fit;
  fit.airframe = with(airframe, chosen, logs);
  fit.sum_of_squares = best.sum_of_squares;
  fit.unfitted_sum_of_squares = residuals_at(VectorXd::Zero(count)).squaredNorm();
  fit.residual_memory = memory_of(residuals_at(logs));
  const VectorXd deviations = best.covariance.diagonal().cwiseSqrt();  // of logarithms: shares of the value
  fit.correlation =
      deviations.cwiseInverse().asDiagonal() * best.covariance * deviations.cwiseInverse().asDiagonal();
  for (Index i = 0; i < count; ++i) {
    const FreeParameter* parameter = chosen[static_cast<std::size_t>(i)];
    const double formal = at_the_edge(logs[i]) ? nothing : deviations[i];
    fit.parameters.push_back(
        {parameter, parameter->in(fit.airframe), formal, formal * std::sqrt(fit.residual_memory)});
  }
  return fit;
}

ReplayFit fit_what_can_be_told(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record,
                               double from_s, double until_s) {
  constexpr double known_share = 0.5;
  std::vector<const FreeParameter*> chosen;
  for (const FreeParameter& parameter : free_parameters()) chosen.push_back(&parameter);
  while (true) {
    const ReplayFit fit = fit_replay(air, airframe, record, chosen, from_s, until_s);
    const auto uncertainty = [](const FittedParameter& fitted) {
      return std::isfinite(fitted.share) ? fitted.share : HUGE_VAL;
    };
    const auto worst = std::max_element(
        fit.parameters.begin(), fit.parameters.end(),
        [&](const FittedParameter& a, const FittedParameter& b) { return uncertainty(a) < uncertainty(b); });
    if (uncertainty(*worst) <= known_share || chosen.size() == 1) return fit;
    chosen.erase(std::find(chosen.begin(), chosen.end(), worst->parameter));
  }
}

}  // namespace understory
