#include <gtest/gtest.h>

#include <functional>

#include "estimation/airspeed.hpp"
#include "estimation/altitude.hpp"
#include "estimation/angle_of_attack.hpp"
#include "estimation/heading.hpp"
#include "estimation/propagation.hpp"
#include "estimation/rest.hpp"
#include "estimation/sideslip.hpp"

namespace understory {
namespace {

constexpr double h = 1e-6;

/// A banked, slipping, turning aircraft: no term of any model vanishes here.
State somewhere() {
  State state;
  state.T_world_body.translation() = Eigen::Vector3d(3, -2, 4);
  state.T_world_body.linear() =
      (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(-0.3, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  state.velocity_body_mps = Eigen::Vector3d(11, 1.7, -2.3);
  state.angular_rate_body_radps = Eigen::Vector3d(4, -0.8, 1.1);
  state.gyro_bias_radps = Eigen::Vector3d(0.01, -0.02, 0.005);
  return state;
}

State nudged(const State& state, int axis, double by, FilterModel model) {
  State moved = state;
  inject(moved, by * Vector12d::Unit(axis), model);
  return moved;
}

/// The innovation must fall, as the estimate moves towards the truth, by the jacobian.
template <int M>
void expect_jacobian(const std::function<Measurement<M>(const State&)>& measure, FilterModel model) {
  const State state = somewhere();
  const Measurement<M> here = measure(state);
  for (int axis = 0; axis < 12; ++axis) {
    const Eigen::Matrix<double, M, 1> slope = (measure(nudged(state, axis, -h, model)).innovation -
                                               measure(nudged(state, axis, h, model)).innovation) /
                                              (2 * h);
    for (int row = 0; row < M; ++row)
      EXPECT_NEAR(slope[row], here.jacobian(row, axis), 1e-6) << row << ' ' << axis;
  }
}

class EitherModel : public testing::TestWithParam<FilterModel> {};
INSTANTIATE_TEST_SUITE_P(Jacobians, EitherModel,
                         testing::Values(FilterModel::gyro_bias, FilterModel::angular_rate));

TEST_P(EitherModel, OfTheMeasurements) {
  const FilterModel model = GetParam();
  const PitotSample pitot{0, 12.0};
  const BarometerSample barometer{0, 4.5};
  const MagnetometerSample magnetometer{
      0, somewhere().T_world_body.linear().transpose() * Eigen::Vector3d(0, 19, -44)};
  expect_jacobian<1>([&](const State& s) { return airspeed(s, pitot, {}); }, model);
  expect_jacobian<1>([&](const State& s) { return altitude(s, barometer, 0.1, {}); }, model);
  expect_jacobian<1>([&](const State& s) { return heading(s, magnetometer, {}); }, model);
  expect_jacobian<1>([&](const State& s) { return sideslip(s, -1.0, {}, model); }, model);
  SideslipConfig zero;
  zero.model = SideslipModel::zero;
  expect_jacobian<1>([&](const State& s) { return sideslip(s, -1.0, zero, model); }, model);
  expect_jacobian<1>([&](const State& s) { return angle_of_attack(s, 12.0, {}, model); }, model);
}

TEST(Jacobians, OfRest) {
  const FilterModel model = FilterModel::gyro_bias;
  const Eigen::Vector3d vector(0.1, -0.2, 9.7);
  expect_jacobian<3>([&](const State& s) { return zero_velocity(s, {}); }, model);
  expect_jacobian<3>([&](const State& s) { return known_position(s, vector, {}); }, model);
  expect_jacobian<3>([&](const State& s) { return gravity_direction(s, vector, 9.81, {}); }, model);
  expect_jacobian<3>([&](const State& s) { return zero_rate(s, vector, 0.1); }, model);
}

/// Difference of two estimates in error coordinates; the last block as `model` has it.
Vector12d difference(const State& to, const State& from, FilterModel model) {
  const Eigen::AngleAxisd apart(
      Eigen::Matrix3d(from.T_world_body.linear().transpose() * to.T_world_body.linear()));
  Vector12d error;
  error << apart.angle() * apart.axis(), to.velocity_body_mps - from.velocity_body_mps,
      to.T_world_body.translation() - from.T_world_body.translation(),
      model == FilterModel::gyro_bias ? to.gyro_bias_radps - from.gyro_bias_radps
                                      : to.angular_rate_body_radps - from.angular_rate_body_radps;
  return error;
}

TEST_P(EitherModel, OfTheStep) {
  const FilterModel model = GetParam();
  InertialStep step{Eigen::Vector3d(4, -0.8, 1.1), Eigen::Vector3d(2, -1, 18), 0.05};
  // One step from a nudged estimate; the nudge of the last block is a nudge of the rate that turns the
  // aircraft.
  const auto after = [&](const State& start, const InertialStep& input) {
    State state = start;
    InertialStep used = input;
    used.angular_rate_body_radps += start.angular_rate_body_radps - somewhere().angular_rate_body_radps;
    advance(state, used, 9.81, model);
    return state;
  };
  State moved = somewhere();
  const StepDerivatives by = advance(moved, step, 9.81, model);
  for (int axis = 0; axis < 12; ++axis) {
    const Vector12d slope = difference(after(nudged(somewhere(), axis, h, model), step),
                                       after(nudged(somewhere(), axis, -h, model), step), model) /
                            (2 * h);
    EXPECT_LT((slope - by.state.col(axis)).norm(), 1e-6) << axis;
  }
  for (int axis = 0; axis < 3; ++axis) {
    InertialStep more = step, less = step;
    more.specific_force_body_mps2[axis] += h / step.dt_s;
    less.specific_force_body_mps2[axis] -= h / step.dt_s;
    const Vector12d by_force =
        difference(after(somewhere(), more), after(somewhere(), less), model) / (2 * h);
    EXPECT_LT((by_force - by.velocity_increment.col(axis)).norm(), 1e-6) << axis;
    more = less = step;
    more.angular_rate_body_radps[axis] += h / step.dt_s;
    less.angular_rate_body_radps[axis] -= h / step.dt_s;
    const Vector12d by_turn = difference(after(somewhere(), more), after(somewhere(), less), model) / (2 * h);
    EXPECT_LT((by_turn - by.rotation.col(axis)).norm(), 1e-6) << axis;
  }
}

}  // namespace
}  // namespace understory
