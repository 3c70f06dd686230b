#pragma once

#include "tests/validation/estimator_trial.hpp"

namespace understory {

/// How the error of a remembered obstacle grew from its detection to its passing.
struct Drift {
  Eigen::Vector2d along_across_m = Eigen::Vector2d::Zero();  ///< level, in the passing aircraft's course
  double vertical_m = 0;
  /// Predicted one-sigma of the level part along and across by the filter's own covariance of position,
  /// grown between the two moments; 0 where it says nothing.
  double stated_sigma_m = 0;

  double total_m() const { return std::hypot(along_across_m.norm(), vertical_m); }
};

/// Of a point `sight_m` ahead along the cameras' axis. A detection every 0.05 s from 0.5 s after the release
/// on, for as long as the passing is in the trace.
std::vector<Drift> drifts(const FlightTrace& flight, const std::vector<TrialMoment>& moments, double sight_m);

/// The share of remembered obstacles whose drift is below the one that is told.
inline constexpr double drift_share = 0.95;

/// Drifts of many detections, of one flight or many.
struct DriftTally {
  std::vector<double> total_m;
  std::vector<double> across_m;  ///< the part across the path
  double squared_sum_m2 = 0;     ///< of the totals
  double stated_squared_sum_m2 = 0;

  void add(const std::vector<Drift>& drifts);
  double quantile_m(double share = drift_share) const;  ///< of the totals; nan where there are none
  double across_quantile_m() const;                     ///< of the parts across the path; likewise
  double rms_m() const;
  double stated_rms_m() const;  ///< by the filter's own covariance
  double over_stated() const;   ///< RMS over the RMS that the covariance states; 1 is honest
};

}  // namespace understory
