#include "tests/validation/consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
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

Consistency averaged(int which, const std::vector<SquaredErrors>& trials) {
  const auto at = static_cast<std::size_t>(which);
  Consistency result;
  result.name = squared_names[at];
  result.degrees = squared_degrees[at];
  const double flights = static_cast<double>(trials.size());
  result.low = chi_square_quantile_of_many(0.025, result.degrees * flights) / flights;
  result.high = chi_square_quantile_of_many(0.975, result.degrees * flights) / flights;
  std::size_t moments = trials.front().squared.size();
  for (const SquaredErrors& trial : trials) moments = std::min(moments, trial.squared.size());
  double sum_of_all = 0;
  int inside = 0;
  for (std::size_t i = 0; i < moments; ++i) {
    double sum = 0;
    for (const SquaredErrors& trial : trials) sum += trial.squared[i][at];
    if (!std::isfinite(sum)) continue;  // nothing measured at this moment
    const double average = sum / flights;
    result.since_release_s.push_back(trials.front().since_release_s[i]);
    result.average.push_back(average);
    sum_of_all += average;
    if (average >= result.low && average <= result.high) ++inside;
  }
  const double count = static_cast<double>(result.average.size());
  result.share_inside = count > 0 ? inside / count : nothing;
  result.mean_over_degrees = count > 0 ? sum_of_all / count / result.degrees : nothing;
  return result;
}

}  // namespace

const std::array<const char*, squared_count> squared_names{"attitude", "velocity", "position drift",
                                                           "airspeed", "altitude", "sideslip"};
const std::array<int, squared_count> squared_degrees{3, 3, 3, 1, 1, 1};

SquaredErrors squared_errors(const std::vector<TrialMoment>& moments, double release_s, double from_s,
                             double to_s) {
  SquaredErrors errors;
  for (const TrialMoment& moment : moments) {
    const double since_s = 1e-9 * static_cast<double>(moment.truth.t_ns) - release_s;
    if (since_s < from_s || since_s > to_s) continue;
    const auto nis = [&](Aid aid) { return moment.innovations_squared[static_cast<std::size_t>(aid)]; };
    errors.since_release_s.push_back(since_s);
    errors.squared.push_back({block_nees(moment, attitude_block), block_nees(moment, velocity_block),
                              block_nees(moment, position_block), nis(Aid::airspeed), nis(Aid::altitude),
                              nis(Aid::sideslip)});
  }
  return errors;
}

std::vector<Consistency> consistency(const std::vector<SquaredErrors>& trials) {
  std::vector<Consistency> all;
  for (int which = 0; which < squared_count; ++which) all.push_back(averaged(which, trials));
  return all;
}

double chi_square_quantile_of_many(double probability, double degrees) {
  const double spread = 2 / (9 * degrees);
  const double root = 1 - spread + normal_quantile(probability) * std::sqrt(spread);
  return degrees * root * root * root;
}

}  // namespace understory
