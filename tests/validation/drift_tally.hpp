#pragma once

#include <vector>

#include "tests/validation/estimator_trial.hpp"

namespace understory {

/// Drifts of many detections, of one flight or many.
struct DriftTally {
  std::vector<double> total_m;
  std::vector<double> across_m;  ///< the part across the path
  double squared_sum_m2 = 0;     ///< of the totals
  double stated_squared_sum_m2 = 0;
  void add(const std::vector<Drift>& drifts);
  void add(const DriftTally& other);
  double quantile_m(double share) const;         ///< of the totals; nan where there are none
  double across_quantile_m(double share) const;  ///< of the parts across the path; likewise
  double rms_m() const;
  double stated_rms_m() const;  ///< by the filter's own covariance
  double over_stated() const;   ///< RMS over the RMS that the covariance states; 1 is honest
};

}  // namespace understory
