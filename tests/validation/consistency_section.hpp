#pragma once

#include <filesystem>

#include "tests/validation/estimator_trial.hpp"
#include "tests/validation/section.hpp"

namespace understory {

/// Calm air, sensors whose noise is exactly what the filter is told: whether its uncertainty is true.
Section matched_consistency_section(const std::filesystem::path& root, int flights);
/// The windy preset in 3 m/s of wind and Dryden turbulence.
Section turbulent_consistency_section(const std::filesystem::path& root, int flights);

/// Sensors with white noise and constants alone, and a filter that is told their sizes. Aerodynamics as
/// measurements are off: their noise is the accelerometer's, which moves the filter already.
TrialConfig matched_trial(const Scenario& scenario, std::uint64_t sensor_seed);
/// forest.yaml in calm air, the catapult firing midway between two IMU samples, as it does on average.
Scenario matched_scenario(std::uint64_t seed, const std::filesystem::path& root);

/// Between these times after the release every forest flight is on its way.
inline constexpr double consistency_from_s = 0.3, consistency_to_s = 5.0;

}  // namespace understory
