#pragma once

#include <cstdint>

#include "estimation/state.hpp"
#include "planning/controls.hpp"
#include "planning/flight_model.hpp"
#include "planning/plan.hpp"

namespace understory {

/// Gains of the inner loops. The outer laws (bank to roll rate, climb to angle of attack, speed to thrust)
/// are those of the flight model, so that the aircraft answers as planned.
struct PathFollowerConfig {
  double pitch_time_s = 0.05;            ///< in which a pitch rate error is taken out
  double angle_of_attack_time_s = 0.09;  ///< in which an angle of attack error is taken out
  double roll_time_s = 0.05;             ///< in which a roll rate error is taken out
};

template <typename Visitor>
void visit_fields(Visitor& visit, PathFollowerConfig& config) {
  visit("pitch_time_s", config.pitch_time_s, 0.005, 1.0);
  visit("angle_of_attack_time_s", config.angle_of_attack_time_s, 0.005, 1.0);
  visit("roll_time_s", config.roll_time_s, 0.005, 1.0);
}

/// The command of `plan` in force at `t_ns`; the last one after its end; level flight where it is empty.
FlightCommand command_at(const Plan& plan, std::int64_t t_ns);

/// Elevons and throttle that fly `command` from `state`, by inverse dynamics of the flat-plate elevons.
Controls follow(const FlightModel& model, const PathFollowerConfig& config, const FlightCommand& command,
                const State& state);

}  // namespace understory
