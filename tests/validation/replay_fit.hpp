#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tests/validation/flight_record.hpp"

namespace understory {

/// A number of the airframe that the record might tell.
struct FreeParameter {
  std::string name;
  double& (*in)(Airframe&);
};
/// Roll damping, pitch damping (N m s/rad), elevon lift factor: the three that the identification of the
/// original model left to the flight records.
const std::vector<FreeParameter>& free_parameters();

struct FittedParameter {
  const FreeParameter* parameter = nullptr;
  double value = 0;
  double share = 0;  ///< standard deviation over value, for residuals that hang together as these do; NaN at
                     ///< the edge of the search
};

struct ReplayFit {
  Airframe airframe;  ///< with the fitted values
  std::vector<FittedParameter> parameters;
  Eigen::MatrixXd correlation;
  double residual_memory =
      1;  ///< samples that count as one: (1 + r) / (1 - r), r the residuals' lag-one correlation
  double sum_of_squares = 0;
  double unfitted_sum_of_squares = 0;
};

/// The values of `chosen` parameters, starting from `airframe`'s, at which the replay lies nearest to the
/// record between `from_s` and `until_s`. Residuals: position along x and y, height, roll, each in shares of
/// the tolerance it is held to (0.20 m, 0.20 m, 0.35 m, 4 deg). The search is over logarithms and ends at a
/// factor of e^1.5.
ReplayFit fit_replay(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record,
                     const std::vector<const FreeParameter*>& chosen, double from_s, double until_s);

/// Fits all parameters, then as long as one is not known to half its value leaves the least known of them at
/// its identified value and fits the others.
ReplayFit fit_what_can_be_told(const FreeFlight& air, const Airframe& airframe, const FlightRecord& record,
                               double from_s, double until_s);

}  // namespace understory
