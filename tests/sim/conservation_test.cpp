#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>

#include "sim/aircraft/aircraft.hpp"

/// What the integrator must keep, and how what it does not keep falls with the step. MuJoCo's own scheme,
/// semi-implicit Euler, is of first order: errors halve with the step.
namespace understory {
namespace {

using Eigen::Vector3d;

/// One second of free flight at `rate_hz`, controls held from the start.
Truth flown(const Airframe& airframe, const Controls& held, const Vector3d& angular_rate_body_radps,
            int rate_hz) {
  World world = build_world(UNDERSTORY_SOURCE_DIR "/models", airframe, {}, WorldConfig{});
  world.model->opt.timestep = 1.0 / rate_hz;
  Aircraft aircraft(*world.model, airframe, LaunchConfig{}, Vector3d::Zero());
  Eigen::Isometry3d pose(Eigen::AngleAxisd(-0.19, Vector3d::UnitY()));
  pose.translation() = Vector3d(0, 0, 50);
  aircraft.place(pose, {12, 0, 0}, angular_rate_body_radps, held);
  for (int i = 0; i < rate_hz; ++i) aircraft.step(held);
  EXPECT_EQ(aircraft.truth().t_ns, 1'000'000'000);
  return aircraft.truth();
}

double energy_j(const Airframe& airframe, const Truth& truth) {
  const Vector3d& rate = truth.angular_rate_body_radps;
  return 0.5 * airframe.mass_kg * truth.velocity_world_mps.squaredNorm() +
         0.5 * rate.dot(airframe.inertia_kgm2.cwiseProduct(rate)) +
         airframe.mass_kg * airframe.gravity_mps2 * truth.T_world_body.translation().z();
}

Vector3d spin_world(const Airframe& airframe, const Truth& truth) {
  return truth.T_world_body.linear() * airframe.inertia_kgm2.cwiseProduct(truth.angular_rate_body_radps);
}

/// Lift alone: it stands on the local velocity and so does no work, of the wing on the flight and of the
/// elevons on flight and rotation together. (The winglets' plates cannot be had without their drag.)
Airframe with_lift_alone() {
  Airframe airframe;
  airframe.wing_drag_factor = airframe.elevon_drag_factor = 0;
  airframe.body_drag_area_m2 = airframe.winglet_area_m2 = 0;
  airframe.rate_damping_nmspr.setZero();
  return airframe;
}

TEST(Conservation, LiftAloneKeepsTheEnergy) {
  const Airframe airframe = with_lift_alone();
  const Controls held{0.25, 0.20, 0};
  const Vector3d rate(0.3, 0.1, 0.2);
  Truth start;
  start.T_world_body.translation().z() = 50;
  start.velocity_world_mps = {12, 0, 0};
  start.angular_rate_body_radps = rate;
  const double before_j = energy_j(airframe, start);
  const auto gained_j = [&](int rate_hz) {
    return energy_j(airframe, flown(airframe, held, rate, rate_hz)) - before_j;
  };
  const double coarse = gained_j(600), flight = gained_j(1200), fine = gained_j(2400);
  const double kinetic_j = 0.5 * airframe.mass_kg * 12 * 12;
  EXPECT_LT(std::abs(flight), 0.01 * kinetic_j);
  EXPECT_NEAR(coarse / flight, 2, 0.2);
  EXPECT_NEAR(flight / fine, 2, 0.1);
  EXPECT_LT(std::abs(2 * fine - flight), 0.02 * std::abs(flight));  // towards a step of zero: nothing gained
}

TEST(Conservation, VacuumKeepsMomentum) {
  Airframe airframe;
  airframe.air_density_kgpm3 = 1e-12;
  airframe.rate_damping_nmspr.setZero();
  const Vector3d rate(1, 2, 3);
  const Vector3d spin_before =
      Eigen::AngleAxisd(-0.19, Vector3d::UnitY()) * airframe.inertia_kgm2.cwiseProduct(rate);
  const auto spin_error = [&](int rate_hz) {
    const Truth truth = flown(airframe, {}, rate, rate_hz);
    EXPECT_LT((truth.velocity_world_mps - Vector3d(12, 0, -9.81)).norm(), 1e-6);  // gravity's impulse alone
    return (spin_world(airframe, truth) - spin_before).norm() / spin_before.norm();
  };
  const double coarse = spin_error(600), flight = spin_error(1200), fine = spin_error(2400);
  EXPECT_LT(flight, 0.005);
  EXPECT_NEAR(coarse / flight, 2, 0.2);
  EXPECT_NEAR(flight / fine, 2, 0.1);
}

// The whole model, rolling into a turn under thrust: against a step 32 times finer than the flight's.
TEST(Conservation, StepsConvergeWithTheIntegratorsOrder) {
  const Airframe airframe;
  const Controls held{0.30, 0.16, 5};
  const Truth limit = flown(airframe, held, Vector3d::Zero(), 38400);
  const auto errors = [&](int rate_hz) {
    const Truth truth = flown(airframe, held, Vector3d::Zero(), rate_hz);
    return Vector3d((truth.T_world_body.translation() - limit.T_world_body.translation()).norm(),
                    (truth.velocity_world_mps - limit.velocity_world_mps).norm(),
                    (truth.angular_rate_body_radps - limit.angular_rate_body_radps).norm());
  };
  const Vector3d coarse = errors(600), flight = errors(1200), fine = errors(2400);
  RecordProperty("position_error_mm_at_1200_hz", std::to_string(1000 * flight.x()));
  EXPECT_LT(flight.x(), 0.02);  // m after 12 m of flight: far below the map's decimetres
  for (int i = 0; i < 3; ++i) {
    // First order, less what the reference itself is off.
    EXPECT_NEAR(coarse[i] / flight[i], (1 - 1.0 / 64) / (0.5 - 1.0 / 64), 0.2) << i;
    EXPECT_NEAR(flight[i] / fine[i], (0.5 - 1.0 / 64) / (0.25 - 1.0 / 64), 0.2) << i;
  }
}

}  // namespace
}  // namespace understory
