#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/validation/estimator_trial.hpp"

namespace understory {

/// What is asked whether it is as large as the filter says: squared normalized errors (NEES) of three blocks,
/// squared normalized innovations (NIS) of three measurements.
inline constexpr int squared_count = 6;
extern const std::array<const char*, squared_count> squared_names;
extern const std::array<int, squared_count> squared_degrees;

/// Of one trial: at each moment since the release, s, the six; nan where nothing was measured.
struct SquaredErrors {
  std::vector<double> since_release_s;
  std::vector<std::array<double, squared_count>> squared;
};

SquaredErrors squared_errors(const std::vector<TrialMoment>& moments, double release_s, double from_s,
                             double to_s);

/// One of the six, averaged over flights at each moment, against the spread that an honest filter shows:
/// chi-square (Bar-Shalom, Li and Kirubarajan 2001, section 5.4).
struct Consistency {
  std::string name;
  int degrees = 3;
  std::vector<double> since_release_s;
  std::vector<double> average;   ///< over the flights; `degrees` is what it should be
  double low = 0, high = 0;      ///< 95 % of the averages of an honest filter lie between
  double share_inside = 0;       ///< of the moments
  double mean_over_degrees = 0;  ///< of all moments and flights, divided by `degrees`: 1 is honest
};

/// Each trial is one flight with sensors of its own; the shortest decides how far it goes.
std::vector<Consistency> consistency(const std::vector<SquaredErrors>& trials);

/// The value below which a chi-square variable falls with `probability` (Wilson and Hilferty 1931; relative
/// error below 1 % from 10 degrees on).
double chi_square_quantile_of_many(double probability, double degrees);

}  // namespace understory
