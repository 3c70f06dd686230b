#pragma once

#include <string>
#include <vector>

#include "scenarios/validation/estimator_trial.hpp"

namespace understory {

/// A squared normalized error or innovation, averaged over flights at each moment, against the spread that an
/// honest filter shows: chi-square (Bar-Shalom, Li and Kirubarajan 2001, section 5.4).
struct Consistency {
  std::string name;
  int degrees = 3;
  std::vector<double> since_release_s;
  std::vector<double> average;       ///< over the flights; `degrees` is what it should be
  double low = 0, high = 0;          ///< 95 % of the averages of an honest filter lie between
  double share_inside = 0;           ///< of the moments
  double mean_over_degrees = 0;      ///< of all moments and flights, divided by `degrees`: 1 is honest
};

/// NEES of attitude, velocity and position drift, NIS of airspeed, altitude and sideslip, from `from_s` to
/// `to_s` after the release. Each trial is one flight with sensors of its own; all must reach `to_s`.
std::vector<Consistency> consistency(const std::vector<std::vector<TrialMoment>>& trials, double release_s,
                                     double from_s, double to_s);

/// The value below which a chi-square variable falls with `probability` (Wilson and Hilferty 1931; relative
/// error below 1 % from 10 degrees on).
double chi_square_quantile_of_many(double probability, double degrees);

}  // namespace understory
