#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/validation/estimator_trial.hpp"

namespace understory {

/// What is asked whether it is as large as the filter says: squared normalized errors (NEES) of three blocks,
/// squared normalized innovations (NIS) of three measurements.
struct SquaredError {
  const char* name;
  int degrees;
};
inline constexpr std::array<SquaredError, 6> squared_errors{{{"attitude", 3},
                                                             {"velocity", 3},
                                                             {"position drift", 3},
                                                             {"airspeed", 1},
                                                             {"altitude", 1},
                                                             {"sideslip", 1}}};

/// Of one moment of a trial, since the release; nan where nothing was measured.
struct SquaredMoment {
  double since_release_s = 0;
  std::array<double, squared_errors.size()> squared{};
};

/// Between 0.3 and 5 s after the release, when every forest flight is on its way.
std::vector<SquaredMoment> squared_moments(const FlightTrace& flight, const TrialConfig& trial);
/// How long a flight must last for that.
inline constexpr double consistency_minimum_s = 6;

/// One of the six, averaged over flights at each moment, against the spread that an honest filter shows:
/// chi-square (Bar-Shalom, Li and Kirubarajan 2001, section 5.4).
struct Consistency {
  std::string name;
  int degrees = 3;
  std::vector<std::pair<double, double>>
      averages;                  ///< since the release, s; over the flights: should be `degrees`
  double low = 0, high = 0;      ///< 95 % of the averages of an honest filter lie between
  double share_inside = 0;       ///< of the moments
  double mean_over_degrees = 0;  ///< of all moments and flights, divided by `degrees`: 1 is honest
};

/// Each trial is one flight with sensors of its own; the shortest decides how far it goes. Without what was
/// never measured.
std::vector<Consistency> consistency(const std::vector<std::vector<SquaredMoment>>& trials);

/// forest.yaml in calm air, the catapult firing midway between two IMU samples, as it does on average.
Scenario matched_scenario(std::uint64_t seed);
/// Sensors with white noise and constants alone, and a filter that is told their sizes. Aerodynamics as
/// measurements are off: their noise is the accelerometer's, which moves the filter already.
TrialConfig matched_trial(const FlightTrace& flight, std::uint64_t sensor_seed);

}  // namespace understory
