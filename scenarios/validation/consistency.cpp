#include "scenarios/validation/consistency.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <limits>

namespace understory {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

double block_nees(const TrialMoment& moment, int block) {
  const Eigen::Vector3d error = error_of(moment).segment<3>(block);
  const Eigen::Matrix3d spread = moment.estimate.covariance.block<3, 3>(block, block);
  return error.dot(spread.ldlt().solve(error));
}

double normal_quantile(double probability) {
  double low = -10, high = 10;
  for (int halving = 0; halving < 80; ++halving) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::sqrt(2.0)) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Consistency averaged(const std::string& name, int degrees, const std::vector<std::vector<TrialMoment>>& trials,
                     double release_s, double from_s, double to_s,
                     const std::function<double(const TrialMoment&)>& squared) {
  Consistency result;
  result.name = name;
  result.degrees = degrees;
  const double flights = static_cast<double>(trials.size());
  result.low = chi_square_quantile_of_many(0.025, degrees * flights) / flights;
  result.high = chi_square_quantile_of_many(0.975, degrees * flights) / flights;
  double sum_of_all = 0;
  int inside = 0;
  for (std::size_t i = 0; i < trials.front().size(); ++i) {
    const double since_s = 1e-9 * static_cast<double>(trials.front()[i].truth.t_ns) - release_s;
    if (since_s < from_s || since_s > to_s) continue;
    double sum = 0;
    for (const auto& trial : trials) sum += squared(trial.at(i));
    if (!std::isfinite(sum)) continue;  // nothing measured at this moment
    const double average = sum / flights;
    result.since_release_s.push_back(since_s);
    result.average.push_back(average);
    sum_of_all += average;
    if (average >= result.low && average <= result.high) ++inside;
  }
  const double count = static_cast<double>(result.average.size());
  result.share_inside = count > 0 ? inside / count : nothing;
  result.mean_over_degrees = count > 0 ? sum_of_all / count / degrees : nothing;
  return result;
}

}  // namespace

std::vector<Consistency> consistency(const std::vector<std::vector<TrialMoment>>& trials, double release_s,
                                     double from_s, double to_s) {
  const auto nees = [&](const std::string& name, int block) {
    return averaged(name, 3, trials, release_s, from_s, to_s,
                    [block](const TrialMoment& moment) { return block_nees(moment, block); });
  };
  const auto nis = [&](const std::string& name, Aid aid) {
    return averaged(name, 1, trials, release_s, from_s, to_s, [aid](const TrialMoment& moment) {
      return moment.innovations_squared[static_cast<std::size_t>(aid)];
    });
  };
  return {nees("attitude", attitude_block), nees("velocity", velocity_block),
          nees("position drift", position_block), nis("airspeed", Aid::airspeed),
          nis("altitude", Aid::altitude), nis("sideslip", Aid::sideslip)};
}

double chi_square_quantile_of_many(double probability, double degrees) {
  const double spread = 2 / (9 * degrees);
  const double root = 1 - spread + normal_quantile(probability) * std::sqrt(spread);
  return degrees * root * root * root;
}

}  // namespace understory
