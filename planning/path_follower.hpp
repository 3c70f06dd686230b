#pragma once

#include <cstdint>

#include "estimation/state.hpp"
#include "planning/airframe.hpp"
#include "planning/autopilot_config.hpp"
#include "planning/flight_model.hpp"
#include "planning/plan.hpp"

namespace understory {

/// The command of `plan` in force at `t_ns`; the last one after its end; level flight where it is empty.
FlightCommand command_at(const Plan& plan, std::int64_t t_ns);

/// Elevons and throttle that fly `command` from `state`, by inverse dynamics of the flat-plate elevons.
Controls follow(const FlightModel& model, const PathFollowerConfig& config, const FlightCommand& command,
                const State& state);

}  // namespace understory
