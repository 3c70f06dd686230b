#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "estimation/measurements.hpp"
#include "estimation/propagation.hpp"
#include "estimation/so3.hpp"

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
  state.accelerometer_bias_mps2 = Eigen::Vector3d(0.1, -0.2, 0.3);
  state.wind_world_mps = Eigen::Vector2d(2.5, -1.5);
  state.gust_world_mps = Eigen::Vector2d(-0.5, 0.8);
  state.pitot_bias_mps = 0.3;
  state.barometer_offset_m = -0.2;
  state.inertial_velocity_world_mps = Eigen::Vector3d(9, -2, 1);
  state.inertial_position_world_m = Eigen::Vector3d(2, 1, 3);
  return state;
}

State nudged(const State& state, int axis, double by, FilterModel model) {
  State moved = state;
  inject(moved, by * ErrorVector::Unit(axis), model);
  return moved;
}

/// As the estimate moves towards the truth, the innovation must decrease by the jacobian.
template <int M>
void expect_jacobian(const std::function<Measurement<M>(const State&)>& measure, FilterModel model) {
  const State state = somewhere();
  const Measurement<M> here = measure(state);
  for (int axis = 0; axis < error_states; ++axis) {
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
  expect_jacobian<1>([&](const State& s) { return altitude(s, barometer, 2.0, {}); }, model);
  expect_jacobian<1>([&](const State& s) { return heading(s, magnetometer, {}); }, model);
  expect_jacobian<1>([&](const State& s) { return sideslip(s, -1.0, {}, model); }, model);
  SideslipConfig zero;
  zero.model = SideslipModel::zero;
  expect_jacobian<1>([&](const State& s) { return sideslip(s, -1.0, zero, model); }, model);
  expect_jacobian<1>([&](const State& s) { return angle_of_attack(s, 12.0, {}, model); }, model);
  const State then = somewhere();
  const GpsSample gps{0, Eigen::Vector3d::Zero(), Eigen::Vector3d(10, 1, 2)};
  expect_jacobian<3>([&](const State& s) { return ground_velocity(s, then, gps, {}); }, model);
  ResightingSample resighting;
  resighting.t_ns = 400'000'000;
  expect_jacobian<2>([&](const State& s) { return ground_displacement(s, then, then, resighting); }, model);
}

TEST(Jacobians, OfRest) {
  const FilterModel model = FilterModel::gyro_bias;
  const Eigen::Vector3d vector(0.1, -0.2, 9.7);
  expect_jacobian<3>([&](const State& s) { return zero_velocity(s, {}); }, model);
  expect_jacobian<3>([&](const State& s) { return known_position(s, vector, {}); }, model);
  expect_jacobian<3>([&](const State& s) { return gravity_direction(s, vector, 9.81, {}); }, model);
  expect_jacobian<3>([&](const State& s) { return zero_rate(s, vector, 0.1); }, model);
}

using Motion = Eigen::Matrix<double, motion_rows, 1>;

/// Difference of two motions in error coordinates.
Motion difference(const State& to, const State& from) {
  const Eigen::AngleAxisd apart(
      Eigen::Matrix3d(from.T_world_body.linear().transpose() * to.T_world_body.linear()));
  Motion error;
  error << apart.angle() * apart.axis(), to.velocity_body_mps - from.velocity_body_mps,
      to.T_world_body.translation() - from.T_world_body.translation();
  return error;
}

TEST_P(EitherModel, OfTheStep) {
  const FilterModel model = GetParam();
  InertialStep step{Eigen::Vector3d(4, -0.8, 1.1), Eigen::Vector3d(2, -1, 18), 0.05};
  // One step from a nudged estimate; a nudge of a bias is one of the input that it is taken from, a nudge of
  // the angular rate one of the rate that turns the aircraft.
  const auto after = [&](const State& start, const InertialStep& input) {
    State state = start;
    InertialStep used = input;
    used.angular_rate_body_radps += start.angular_rate_body_radps - somewhere().angular_rate_body_radps;
    used.specific_force_body_mps2 -= start.accelerometer_bias_mps2 - somewhere().accelerometer_bias_mps2;
    advance(state, used, 9.81, model);
    return state;
  };
  State moved = somewhere();
  const StepDerivatives by = advance(moved, step, 9.81, model);
  for (int axis = 0; axis < moving_columns; ++axis) {
    const Motion slope = difference(after(nudged(somewhere(), axis, h, model), step),
                                    after(nudged(somewhere(), axis, -h, model), step)) /
                         (2 * h);
    EXPECT_LT((slope - by.state.col(axis)).norm(), 1e-6) << axis;
  }
  for (int axis = 0; axis < 3; ++axis) {
    InertialStep more = step, less = step;
    more.specific_force_body_mps2[axis] += h / step.dt_s;
    less.specific_force_body_mps2[axis] -= h / step.dt_s;
    const Motion by_force = difference(after(somewhere(), more), after(somewhere(), less)) / (2 * h);
    EXPECT_LT((by_force - by.velocity_increment.col(axis)).norm(), 1e-6) << axis;
    more = less = step;
    more.angular_rate_body_radps[axis] += h / step.dt_s;
    less.angular_rate_body_radps[axis] -= h / step.dt_s;
    const Motion by_turn = difference(after(somewhere(), more), after(somewhere(), less)) / (2 * h);
    EXPECT_LT((by_turn - by.rotation.col(axis)).norm(), 1e-6) << axis;
  }
}

/// F P F' + Q written out in full, against the step that multiplies only what moves. Matrices without a fixed
/// size do for a reference, and compile in half the time.
TEST_P(EitherModel, TheCovarianceStepIsTheFullProduct) {
  const FilterModel model = GetParam();
  State state = somewhere();
  const InertialStep step{Eigen::Vector3d(4, -0.8, 1.1), Eigen::Vector3d(2, -1, 18), 0.05};
  const StepDerivatives by = advance(state, step, 9.81, model);
  const Eigen::MatrixXd root = ErrorCovariance::Random();
  const Eigen::MatrixXd before = root * root.transpose();
  ProcessNoise noise{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 0.7, 2.0};
  const double dt = step.dt_s, kept = std::exp(-dt / noise.gust_time_s);

  Eigen::MatrixXd F = ErrorCovariance::Identity();
  F.topLeftCorner<motion_rows, moving_columns>() = by.state;
  F.block<2, 2>(gust_block, gust_block) *= kept;
  Eigen::MatrixXd expected = F * before * F.transpose();
  const auto noisy = [&](const Eigen::MatrixXd& input, double density) {
    expected.topLeftCorner(motion_rows, motion_rows) += density * density * dt * input * input.transpose();
  };
  if (model == FilterModel::gyro_bias) noisy(by.rotation, noise.gyro_radps_rthz);
  noisy(by.velocity_increment, noise.accelerometer_mps2_rthz);
  Eigen::MatrixXd walk = Eigen::MatrixXd::Zero(error_states, 3);
  walk.topRows<motion_rows>() = 0.5 * dt * rate_sign(model) * by.rotation;
  walk.middleRows<3>(rate_block).setIdentity();
  expected += noise.rate_block_rthz * noise.rate_block_rthz * dt * walk * walk.transpose();
  const double added[] = {0.16 * dt, 0.25 * dt, (1 - kept * kept) * 0.49, 0.36 * dt, 0.64 * dt};
  const int blocks[] = {accelerometer_bias_block, wind_block,           gust_block,  pitot_bias_block,
                        barometer_offset_block,   barometer_wash_block, error_states};
  for (int i = 0; i < 5; ++i)
    expected.diagonal().segment(blocks[i], blocks[i + 1] - blocks[i]).array() += added[i];

  ErrorCovariance stepped = before;
  propagate(stepped, by, noise, dt, model);
  EXPECT_LT((stepped - expected).cwiseAbs().maxCoeff(), 1e-9);
}

/// The multiplied-out update against Joseph's form, with a gain that is withheld in part.
TEST(Update, IsJosephsFormForWithheldGainsToo) {
  const Eigen::MatrixXd root = ErrorCovariance::Random(), identity = ErrorCovariance::Identity();
  State state = somewhere();
  state.covariance = root * root.transpose() + identity;
  const Eigen::MatrixXd before = state.covariance;
  Measurement<2> measurement;
  measurement.jacobian.setRandom();
  measurement.innovation << 0.3, -0.2;
  measurement.noise << 0.5, 0.1, 0.1, 0.4;
  const Eigen::Vector3d up_body = state.T_world_body.linear().row(2);
  const State untouched = state;
  correct(state, measurement, FilterModel::gyro_bias, FrameGain::held);

  const Eigen::MatrixXd jacobian = measurement.jacobian;
  const Eigen::Matrix2d spread = jacobian * before * jacobian.transpose() + measurement.noise;
  Eigen::MatrixXd gain = before * jacobian.transpose() * spread.inverse();
  gain.middleRows<3>(position_block).setZero();
  gain.topRows<3>() = (Eigen::Matrix3d::Identity() - up_body * up_body.transpose()) * gain.topRows<3>();
  const Eigen::MatrixXd rest = identity - gain * jacobian;
  const Eigen::MatrixXd expected =
      rest * before * rest.transpose() + gain * measurement.noise * gain.transpose();
  EXPECT_LT((state.covariance - expected).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(state.T_world_body.translation(), untouched.T_world_body.translation());
  const auto heading = [](const State& s) {
    const Eigen::Matrix3d R = s.T_world_body.linear();
    return std::atan2(R(1, 0), R(0, 0));
  };
  // Held to first order: the turn about a level axis is not a turn of the heading.
  EXPECT_NEAR(heading(state), heading(untouched), 0.02);
  EXPECT_GT((state.T_world_body.linear() - untouched.T_world_body.linear()).norm(), 0.05);
}

std::vector<Eigen::Vector3d> rotation_vectors() {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Eigen::Vector3d> vectors;
  for (const double angle : {0.0, 1e-9, 1e-5, 0.99e-4, 1.01e-4, 0.01, 1.0, 3.0, M_PI - 1e-6}) {
    Eigen::Vector3d axis;
    for (double& value : axis) value = uniform(generator);
    vectors.push_back(angle * axis.normalized());
  }
  return vectors;
}

TEST(So3, ExpAgreesWithEigensAxisAngle) {
  for (const Eigen::Vector3d& vector : rotation_vectors()) {
    const Eigen::Matrix3d plain =
        Eigen::AngleAxisd(vector.norm(), vector.stableNormalized()).toRotationMatrix();
    EXPECT_LT((so3::exp(vector) - plain).norm(), 1e-12) << vector.transpose();
  }
}

TEST(So3, LogUndoesExp) {
  for (const Eigen::Vector3d& vector : rotation_vectors()) {
    EXPECT_LT((so3::log(so3::exp(vector)) - vector).norm(), 1e-9) << vector.transpose();
  }
}

TEST(So3, RightJacobianAgreesWithFiniteDifferences) {
  for (const Eigen::Vector3d& vector : rotation_vectors()) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d nudge = h * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d forward = so3::log(so3::exp(vector).transpose() * so3::exp(vector + nudge));
      const Eigen::Vector3d backward = so3::log(so3::exp(vector).transpose() * so3::exp(vector - nudge));
      EXPECT_LT(((forward - backward) / (2 * h) - so3::right_jacobian(vector).col(axis)).norm(), 1e-7);
    }
  }
}

TEST(So3, SkewIsTheCrossProduct) {
  const Eigen::Vector3d a(1, 2, 3), b(-4, 5, 0.5);
  EXPECT_LT((so3::skew(a) * b - a.cross(b)).norm(), 1e-15);
}

}  // namespace
}  // namespace understory
