#pragma once

#include <filesystem>
#include <functional>

#include "tests/validation/recorded_flight.hpp"

namespace understory {

/// The air of a series of flights, across the flight's direction.
struct Air {
  double wind_mps = 0;
  bool turbulent = false;  ///< Dryden turbulence of a wind of this strength at 20 ft
};

/// scenarios/library/forest.yaml in that air, flown by the default autopilot: how seldom the forest's own
/// plans is not the filter's affair. `root`: the source tree.
Scenario forest_in(const Air& air, std::uint64_t seed, const std::filesystem::path& root);

/// Flies `flights` scenarios one after the other and hands each record to `measure` with its number, on a
/// thread beside, while the next one flies: two cores are kept busy, and results that are kept by number do
/// not depend on it. Flights that end before `minimum_s` of simulated time are left out and counted.
int measure_flights(int flights, const std::function<Scenario(int)>& scenario,
                    const std::filesystem::path& models_folder, double minimum_s,
                    const std::function<void(int, const RecordedFlight&)>& measure);

}  // namespace understory
