#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "estimation/filter.hpp"
#include "perception/map/resightings.hpp"
#include "perception/stereo_rig.hpp"
#include "scenarios/flight/flight_result.hpp"
#include "scenarios/scenario/scenario.hpp"
#include "sim/aircraft/truth.hpp"
#include "sim/scene/obstacle.hpp"

namespace understory {

/// What was true at every physics step of one flight, so that many estimators can be given its sensors'
/// samples without flying again.
struct FlightTrace {
  Scenario scenario;
  StereoRig rig;
  std::vector<Obstacle> obstacles;
  std::vector<Truth> truths = {};  ///< by step
  std::int64_t release_step = 0;
  FlightResult result = {};

  double release_s() const { return static_cast<double>(release_step) / physics_rate_hz; }
};

/// Flies `scenario` on true depth (no image is rendered) and keeps the truth. On the true state no estimate
/// decides anything; on the filter, the flight is what its errors made of it. Throws as Flight does.
FlightTrace traced_flight(Scenario scenario, const std::string& flown_on = "truth");

/// The air of a series of flights, across the flight's direction.
struct Air {
  double wind_mps = 0;
  bool turbulent = false;  ///< Dryden turbulence of a wind of this strength at 20 ft
};

/// scenarios/library/forest.yaml in that air, flown by the default autopilot: how seldom the forest's own
/// plans is not the filter's affair.
Scenario forest_in(const Air& air, std::uint64_t seed);

/// Flies `flights` scenarios one after the other and hands each trace to `measure` with its number, in order,
/// on a thread beside while the next one flies: two cores are kept busy. Flights that end before `minimum_s`
/// of simulated time are left out and counted.
int measure_flights(int flights, const std::function<Scenario(int)>& scenario, double minimum_s,
                    const std::function<void(int, const FlightTrace&)>& measure);

/// What a pushbroom with several depths sees along a flight, frame by frame: every block of a trunk that
/// truly lies at a depth, put at the whole disparity's. Only the truth decides it, so one serves many trials.
struct Sightings {
  std::vector<double> depths_m;
  std::vector<std::int64_t> t_ns;  ///< of the frames
  std::vector<std::vector<StereoHit>> hits;
};

Sightings sightings(const FlightTrace& flight, const std::vector<double>& depths_m);

/// What an estimator is given, beside the flight and its faults.
struct TrialConfig {
  FilterConfig filter;
  SensorsConfig sensors;
  std::uint64_t sensor_seed = 1;
  /// Where given, and `resightings` on, the filter is told of obstacles seen again, one latency late.
  const Sightings* sightings = nullptr;
  ResightingsConfig resightings;
  /// The filter wakes up at the release, knowing pose and airspeed and nothing of the ground's: it takes the
  /// wind for zero, to within 3 m/s.
  bool ground_velocity_unknown = false;
};

/// The flight's own filter and sensors.
TrialConfig trial_of(const FlightTrace& flight, std::uint64_t sensor_seed);
/// Another filter from the same start.
void take_preset(TrialConfig& config, const FilterConfig& preset);
/// The catapult's aim is as uncertain as the filter is told; only the relation matters, so the filter errs.
void draw_aim(TrialConfig& config);

/// One moment of a trial, at the IMU's rate.
struct TrialMoment {
  Truth truth;
  State estimate;
  std::array<double, aid_count> innovations_squared{};  ///< of what arrived since the last moment; else nan

  double t_s() const { return 1e-9 * static_cast<double>(truth.t_ns); }
  /// In the filter's coordinates. What the truth does not name as a state (biases) is left zero.
  ErrorVector error() const;
};

/// Runs sensors, faults and filter along the recorded truth.
std::vector<TrialMoment> run_trial(const FlightTrace& flight, const TrialConfig& config);

}  // namespace understory
