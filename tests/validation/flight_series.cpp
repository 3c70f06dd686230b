#include "tests/validation/flight_series.hpp"

#include <fmt/format.h>

#include <future>
#include <memory>

#include "scenarios/scenario/scenario_io.hpp"

namespace understory {

Scenario forest_in(const Air& air, std::uint64_t seed, const std::filesystem::path& root) {
  Scenario scenario =
      load_scenario(root / "scenarios" / "library" / "forest.yaml", {fmt::format("seed={}", seed)});
  scenario.autopilot = {};
  scenario.wind_world_mps = {0, air.wind_mps, 0};
  if (air.turbulent) scenario.wind.turbulence_wind20_mps = air.wind_mps;
  return scenario;
}

int measure_flights(int flights, const std::function<Scenario(int)>& scenario,
                    const std::filesystem::path& models_folder, double minimum_s,
                    const std::function<void(int, const RecordedFlight&)>& measure) {
  std::future<void> measured;
  int left_out = 0;
  for (int number = 0; number < flights; ++number) {
    auto flight = std::make_shared<RecordedFlight>(recorded_flight(scenario(number), models_folder));
    if (static_cast<double>(flight->truths.size()) < minimum_s * physics_rate_hz) {
      ++left_out;
      continue;
    }
    if (measured.valid()) measured.get();
    measured = std::async(std::launch::async, [&measure, number, flight] { measure(number, *flight); });
  }
  if (measured.valid()) measured.get();
  return left_out;
}

}  // namespace understory
