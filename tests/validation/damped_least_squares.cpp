#include "tests/validation/damped_least_squares.hpp"

#include <Eigen/Dense>

namespace understory {
namespace {

using Residuals = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

Eigen::MatrixXd jacobian(const Residuals& residuals, const Eigen::VectorXd& at, const Eigen::VectorXd& step) {
  Eigen::MatrixXd slopes;
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    Eigen::VectorXd above = at, below = at;
    above[i] += step[i];
    below[i] -= step[i];
    const Eigen::VectorXd column = (residuals(above) - residuals(below)) / (2 * step[i]);
    if (i == 0) slopes.resize(column.size(), at.size());
    slopes.col(i) = column;
  }
  return slopes;
}

}  // namespace

LeastSquares least_squares(const Residuals& residuals, const Eigen::VectorXd& start,
                           const Eigen::VectorXd& step) {
  constexpr int maximum_iterations = 60;
  constexpr double enough = 1e-9;  // relative change of the sum
  LeastSquares best;
  best.parameters = start;
  Eigen::VectorXd now = residuals(start);
  best.sum_of_squares = now.squaredNorm();
  double damping = 1e-3;  // of each parameter's own curvature
  while (best.iterations < maximum_iterations) {
    ++best.iterations;
    const Eigen::MatrixXd slopes = jacobian(residuals, best.parameters, step);
    const Eigen::MatrixXd curvature = slopes.transpose() * slopes;
    if (!slopes.allFinite()) break;  // at the edge of where the residuals are defined
    double gained = 0;
    for (int attempt = 0; attempt < 12 && gained <= 0; ++attempt) {
      Eigen::MatrixXd damped = curvature;
      damped.diagonal() *= 1 + damping;
      const Eigen::VectorXd candidate = best.parameters - damped.ldlt().solve(slopes.transpose() * now);
      const Eigen::VectorXd there = residuals(candidate);
      gained = best.sum_of_squares - there.squaredNorm();
      if (!(gained > 0)) {
        gained = 0;
        damping *= 4;
        continue;
      }
      best.parameters = candidate;
      best.sum_of_squares -= gained;
      now = there;
      damping *= 0.3;
    }
    if (gained <= enough * best.sum_of_squares) break;
  }
  const Eigen::MatrixXd slopes = jacobian(residuals, best.parameters, step);
  best.variance = best.sum_of_squares / static_cast<double>(now.size() - start.size());
  best.covariance =
      best.variance * (slopes.transpose() * slopes).completeOrthogonalDecomposition().pseudoInverse();
  return best;
}

}  // namespace understory
