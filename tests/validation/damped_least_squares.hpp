#pragma once

#include <Eigen/Core>
#include <functional>

namespace understory {

/// Parameters that make the sum of squared residuals least, and how well the data hold them.
struct LeastSquares {
  Eigen::VectorXd parameters;
  double sum_of_squares = 0;
  double variance = 0;  ///< of one residual: sum of squares over degrees of freedom
  Eigen::MatrixXd
      covariance;  ///< of the parameters, for independent residuals: an optimistic bound where they are not
  int iterations = 0;
};

/// Levenberg's and Marquardt's damped Gauss-Newton steps from `start`, central differences of `step` (one per
/// parameter). Ends where a step changes the sum by less than one part in 10^9, or after 60 iterations.
LeastSquares least_squares(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& residuals,
                           const Eigen::VectorXd& start, const Eigen::VectorXd& step);

}  // namespace understory
