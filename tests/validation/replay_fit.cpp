#include "tests/validation/replay_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

namespace understory {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double maximum_log = 1.5;
constexpr int channels = 4;

/// Channel by channel for each sample.
VectorXd residuals(const FlightRecord& flown, const FlightRecord& record, double from_s, double until_s) {
  constexpr double horizontal_m = 0.20, height_m = 0.35, roll_rad = 4 * std::numbers::pi / 180;
  const std::vector<ReplayError> all = errors(flown, record);
  std::vector<double> numbers;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i].t_s < from_s - 1e-9 || all[i].t_s > until_s + 1e-9) continue;
    const Eigen::Vector3d offset = flown[i].position_world - record[i].position_world;
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

/// The replay's residuals over the logarithms of the parameters' factors. Beyond the edge the replay says
/// what it says at the edge: a parameter that runs there has no slope left, and so no certainty.
struct Residuals {
  using Scalar = double;
  using InputType = VectorXd;
  using ValueType = VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const FreeFlight& air;
  const Airframe& identified;
  const FlightRecord& record;
  const std::vector<const FreeParameter*>& chosen;
  double from_s, until_s;

  Airframe airframe(const VectorXd& logs) const {
    Airframe changed = identified;
    for (std::size_t i = 0; i < chosen.size(); ++i)
      chosen[i]->in(changed) *= std::exp(std::clamp(logs[static_cast<Index>(i)], -maximum_log, maximum_log));
    return changed;
  }
  VectorXd at(const VectorXd& logs) const {
    return residuals(replay(air, airframe(logs), record), record, from_s, until_s);
  }
  int values() const {
    return static_cast<int>(at(VectorXd::Zero(static_cast<Index>(chosen.size()))).size());
  }
  int operator()(const VectorXd& logs, VectorXd& values) const {
    values = at(logs);
    return 0;
  }
};

}  // namespace

const std::vector<FreeParameter>& free_parameters() {
  static const std::vector<FreeParameter> all{
      {"roll damping", [](Airframe& airframe) -> double& { return airframe.rate_damping_nmspr.x(); }},
      {"pitch damping", [](Airframe& airframe) -> double& { return airframe.rate_damping_nmspr.y(); }},
      {"elevon lift factor", [](Airframe& airframe) -> double& { return airframe.elevon_lift_factor; }}};
  return all;
}

ReplayFit fit_replay(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record,
                     const std::vector<const FreeParameter*>& chosen, double from_s, double until_s) {
  const auto count = static_cast<Index>(chosen.size());
  const Residuals residuals{air, airframe, record, chosen, from_s, until_s};
  using Sloped = Eigen::NumericalDiff<Residuals, Eigen::Central>;
  Sloped sloped(residuals, 1e-6);  // differences of its root
  VectorXd logs = VectorXd::Zero(count);
  ReplayFit fit;
  fit.unfitted_sum_of_squares = residuals.at(logs).squaredNorm();
  Eigen::LevenbergMarquardt<Sloped> search(sloped);
  search.parameters.ftol = search.parameters.xtol = 1e-9;
  search.minimize(logs);

  const VectorXd left = residuals.at(logs);
  fit.airframe = residuals.airframe(logs);
  fit.sum_of_squares = left.squaredNorm();
  fit.residual_memory = memory_of(left);
  Eigen::MatrixXd slopes(left.size(), count);
  sloped.df(logs, slopes);
  const Eigen::MatrixXd covariance =
      fit.sum_of_squares / static_cast<double>(left.size() - count) *
      (slopes.transpose() * slopes).completeOrthogonalDecomposition().pseudoInverse();
  const VectorXd deviations = covariance.diagonal().cwiseSqrt();  // of logarithms: shares of the value
  fit.correlation =
      deviations.cwiseInverse().asDiagonal() * covariance * deviations.cwiseInverse().asDiagonal();
  for (Index i = 0; i < count; ++i) {
    const FreeParameter* parameter = chosen[static_cast<std::size_t>(i)];
    const bool at_the_edge = std::abs(logs[i]) > 0.99 * maximum_log;
    const double share = at_the_edge ? std::numeric_limits<double>::quiet_NaN()
                                     : deviations[i] * std::sqrt(fit.residual_memory);
    fit.parameters.push_back({parameter, parameter->in(fit.airframe), share});
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
