#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planning/path_follower.hpp"
#include "scenarios/parts/oracles.hpp"
#include "sim/aircraft/aircraft.hpp"

/// The reduced model that plans are made with, against MuJoCo flying the follower's elevons.
namespace understory {
namespace {

constexpr double step_s = 0.02;               // of the prediction
constexpr int physics_steps_per_step = 24;    // the same in physics steps
constexpr int physics_steps_per_control = 6;  // 200 Hz
constexpr int delay_physics_steps = 24;       // the airframe's input delay, 20 ms

State knowing_the_wind(const Truth& truth) {
  State state = state_of(truth);
  state.wind_world_mps = truth.wind_world_mps.head<2>();
  return state;
}

struct Command {
  FlightCommand command;
  int steps;
};

class Tracking {
 public:
  Tracking(double cruise_speed_mps, const Eigen::Vector3d& wind_world_mps)
      : model_(airframe_, config_at(cruise_speed_mps)), wind_world_mps_(wind_world_mps) {}

  /// Squared distance between prediction and flight `after_s` into a random sequence of commands.
  double squared_error_m2(std::mt19937_64& generator, double after_s) {
    Aircraft aircraft(*world_.model, airframe_, LaunchConfig{}, wind_world_mps_);
    const double speed = model_.config().cruise_speed_mps;
    const double attack = 0.1914 * (12.27 * 12.27) / (speed * speed);
    Eigen::Isometry3d pose(Eigen::AngleAxisd(-attack, Eigen::Vector3d::UnitY()));
    pose.translation().z() = 30;
    aircraft.place(pose, Eigen::Vector3d(speed, 0, 0) + wind_world_mps_, Eigen::Vector3d::Zero(),
                   {0.19, 0.19, 5});
    fly(aircraft, {0, 0}, 50 * physics_steps_per_step);  // a second to settle

    // A command acts one input delay later: until then the aircraft flies on under the last one.
    FlightState predicted = flight_state(knowing_the_wind(aircraft.truth()));
    predicted = model_.advance(predicted, {0, 0}, step_s);
    int physics_steps = delay_physics_steps, to_go = static_cast<int>(std::lround(after_s / step_s));
    while (to_go > 0) {
      const Command part = random_command(generator, to_go);
      for (int i = 0; i < part.steps; ++i) predicted = model_.advance(predicted, part.command, step_s);
      fly(aircraft, part.command, part.steps * physics_steps_per_step);
      last_command_ = part.command;
      to_go -= part.steps;
    }
    fly(aircraft, last_command_, physics_steps);
    return (predicted.position_world - aircraft.truth().T_world_body.translation()).squaredNorm();
  }

 private:
  static FlightModelConfig config_at(double cruise_speed_mps) {
    FlightModelConfig config;
    config.cruise_speed_mps = cruise_speed_mps;
    return config;
  }

  Command random_command(std::mt19937_64& generator, int maximum_steps) {
    const auto uniform = [&](double minimum, double maximum) {
      return std::uniform_real_distribution<double>(minimum, maximum)(generator);
    };
    const double bank = uniform(-1.4, 1.4), climb = uniform(-1, 2);
    return {{bank, climb}, std::min(maximum_steps, static_cast<int>(uniform(5, 20)))};
  }

  void fly(Aircraft& aircraft, const FlightCommand& command, int physics_steps) {
    Controls controls;
    for (int i = 0; i < physics_steps; ++i) {
      if (i % physics_steps_per_control == 0)
        controls = follow(model_, PathFollowerConfig{}, command, knowing_the_wind(aircraft.truth()));
      aircraft.step(controls);
    }
  }

  Airframe airframe_;
  FlightModel model_;
  Eigen::Vector3d wind_world_mps_;
  World world_ = build_world(UNDERSTORY_SOURCE_DIR "/models", airframe_, {}, WorldConfig{});
  FlightCommand last_command_;
};

/// RMS errors of the prediction half a second and a second ahead stay within what the planner is built for.
void expect_predicted(double cruise_speed_mps, const Eigen::Vector3d& wind_world_mps) {
  Tracking tracking(cruise_speed_mps, wind_world_mps);
  std::mt19937_64 generator(5);
  double half_second = 0, second = 0;
  constexpr int trials = 40;
  for (int trial = 0; trial < trials; ++trial) {
    half_second += tracking.squared_error_m2(generator, 0.5);
    second += tracking.squared_error_m2(generator, 1.0);
  }
  EXPECT_LT(std::sqrt(half_second / trials), 0.07) << "at " << cruise_speed_mps << " m/s";
  EXPECT_LT(std::sqrt(second / trials), 0.3) << "at " << cruise_speed_mps << " m/s";
}

TEST(FlightModelTracking, PredictsWhereTheSimulatorWillBe) {
  for (const double cruise_speed_mps : {10.0, 12.0}) expect_predicted(cruise_speed_mps, {0, 0, 0});
}

TEST(FlightModelTracking, PredictsItInAWindThatIsKnown) {
  for (const Eigen::Vector3d& wind_world_mps : {Eigen::Vector3d(0, 3, 0), Eigen::Vector3d(-4, -2, 0)})
    expect_predicted(12, wind_world_mps);
}

}  // namespace
}  // namespace understory
