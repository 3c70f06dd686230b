#pragma once

#include <array>

#include "tests/validation/free_flight.hpp"

namespace understory {

/// Elevons held at three pairs of deflections, one after the other: roll, pull, and what then is best.
struct DodgeCommands {
  std::array<double, 3> left_elevon_rad{};
  std::array<double, 3> right_elevon_rad{};
  std::array<double, 2> duration_s{};  ///< of the first two
};

struct DodgeTask {
  double airspeed_mps = 12;
  double distance_m = 10;     ///< ahead, from where the obstacle is seen
  double reaction_s = 0;      ///< flown straight on before anything is done
  double servo_lag_s = 0.03;  ///< FACTS section 3; the simulator's elevons have none of their own
  double height_lost_m = 0.5;
  double angle_of_attack_cap_rad = 0.5236;
};

/// How far to the right the aircraft is when it has come `distance_m` ahead, less a penalty for height lost
/// and angle of attack beyond what the task allows.
double sideways_m(const FreeFlight& air, const Airframe& airframe, const DodgeTask& task,
                  const DodgeCommands& commands);

/// The farthest that a random search of fixed seed finds: a lower bound of what the airframe can do.
double farthest_sideways_m(const FreeFlight& air, const Airframe& airframe, const DodgeTask& task);

}  // namespace understory
