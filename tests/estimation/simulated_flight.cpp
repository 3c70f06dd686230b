#include "simulated_flight.hpp"

#include <algorithm>
#include <cmath>

namespace understory::test {
namespace {

constexpr double gravity = 9.81, density = 1.204, mass = 0.648412;
constexpr double degree = M_PI / 180;
using Vector11d =
    Eigen::Matrix<double, 11, 1>;  // position, velocity in body axes, quaternion (x y z w), yaw rate

/// A smooth turn of `angle` over `duration` from `start`: its rate at t.
double bell(double t, double start, double duration, double angle) {
  if (t < start || t > start + duration) return 0;
  return angle / duration * (1 - std::cos(2 * M_PI * (t - start) / duration));
}

struct Loads {
  Eigen::Vector3d rate, force;
  double yaw_acceleration;
};

Loads loads(const Vector11d& x, double t, const Manoeuvre& manoeuvre) {
  const double u = x[3], v = x[4], w = x[5], r = x[10];
  const double p = manoeuvre.roll_rate(t);
  const double q =
      8 * (std::atan2(-w, u) - manoeuvre.angle_of_attack(t));  // nose down where the angle is too large
  // Winglets: plates in the x-y plane at (-0.08, 0, 0.082), normal force coefficient 2 sin(beta).
  const double u_local = u + q * 0.081954, v_local = v + r * -0.08 - p * 0.081954;
  const double beta = std::atan2(v_local, u_local);
  const double side =
      -0.5 * density * (u_local * u_local + v_local * v_local) * 0.038882 * 2 * std::sin(beta) / mass;
  const double alpha = std::atan2(-w, u);
  const double normal =
      0.5 * density * (u * u + w * w) * 0.1811 * 2 * std::sin(alpha) / mass + 0.115 * q / (0.145 * mass);
  const double forward = 1.85 + 1.5 * (12.0 - u);
  return {{p, q, r}, {forward, side, normal}, -0.08 * side * mass / 0.01835};
}

Vector11d derivative(const Vector11d& x, double t, const Manoeuvre& manoeuvre) {
  const Loads now = loads(x, t, manoeuvre);
  const Eigen::Quaterniond attitude(x[9], x[6], x[7], x[8]);
  const Eigen::Quaterniond spin = attitude * Eigen::Quaterniond(0, now.rate.x(), now.rate.y(), now.rate.z());
  const Eigen::Vector3d velocity = x.segment<3>(3);
  Vector11d d;
  d.head<3>() = attitude * velocity;
  d.segment<3>(3) =
      now.force - now.rate.cross(velocity) + attitude.inverse() * Eigen::Vector3d(0, 0, -gravity);
  d.segment<4>(6) = 0.5 * spin.coeffs();
  d[10] = now.yaw_acceleration;
  return d;
}

void step(Vector11d& x, double t, double h, const Manoeuvre& manoeuvre) {
  const Vector11d a = derivative(x, t, manoeuvre);
  const Vector11d b = derivative(x + 0.5 * h * a, t + 0.5 * h, manoeuvre);
  const Vector11d c = derivative(x + 0.5 * h * b, t + 0.5 * h, manoeuvre);
  const Vector11d d = derivative(x + h * c, t + h, manoeuvre);
  x += h / 6 * (a + 2 * b + 2 * c + d);
  x.segment<4>(6).normalize();
}

/// On the rail: at rest, then constantly accelerated.
Moment on_rail(double t, const Launch& launch) {
  const double acceleration = launch.speed_mps * launch.speed_mps / (2 * launch.rail_m);
  const double pushed = std::max(0.0, t - launch.rest_s);
  const Eigen::Matrix3d attitude =
      Eigen::AngleAxisd(-launch.climb_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  Moment moment;
  moment.T_world_body.linear() = attitude;
  moment.T_world_body.translation() =
      Eigen::Vector3d(0, 0, launch.altitude_m) +
      attitude.col(0) * (0.5 * acceleration * pushed * pushed - launch.rail_m);
  moment.velocity_body.x() = acceleration * pushed;
  moment.force_body = attitude.transpose() * Eigen::Vector3d(0, 0, gravity);
  if (t > launch.rest_s) moment.force_body.x() += acceleration;
  return moment;
}

}  // namespace

Manoeuvre straight() { return {}; }

Manoeuvre dodge() {
  Manoeuvre manoeuvre;
  manoeuvre.roll_rate = [](double t) {
    return bell(t, 1.0, 0.4, -60 * degree) + bell(t, 1.7, 0.6, 120 * degree) +
           bell(t, 2.6, 0.4, -60 * degree);
  };
  manoeuvre.angle_of_attack = [](double t) {
    const auto ramp = [t](double start) {
      return 0.5 - 0.5 * std::cos(M_PI * std::clamp((t - start) / 0.3, 0.0, 1.0));
    };
    return 0.191 + 0.31 * (ramp(1.0) - ramp(2.6));
  };
  return manoeuvre;
}

std::vector<Moment> fly(const Manoeuvre& manoeuvre, double flying_s, const Launch& launch) {
  constexpr std::int64_t period_ns = 5'000'000;
  const double release_s = launch.rest_s + 2 * launch.rail_m / launch.speed_mps;
  std::vector<Moment> moments;
  std::int64_t t_ns = 0;
  for (; 1e-9 * t_ns < release_s - 1e-9; t_ns += period_ns) {
    moments.push_back(on_rail(1e-9 * t_ns, launch));
    moments.back().t_ns = t_ns;
  }
  const Moment release = on_rail(release_s, launch);
  Vector11d x;
  x << release.T_world_body.translation(), release.velocity_body,
      Eigen::Quaterniond(release.T_world_body.linear()).coeffs(), 0;
  double t = 0;  // the first moment after release need not be a whole period away
  for (; t < flying_s; t_ns += period_ns) {
    const double due = 1e-9 * t_ns - release_s;
    const int pieces = 6;
    const double h = (due - t) / pieces;
    for (int piece = 0; piece < pieces; ++piece, t += h) step(x, t, h, manoeuvre);
    t = due;
    const Loads now = loads(x, t, manoeuvre);
    Moment moment;
    moment.t_ns = t_ns;
    moment.T_world_body.translation() = x.head<3>();
    moment.T_world_body.linear() = Eigen::Quaterniond(x[9], x[6], x[7], x[8]).toRotationMatrix();
    moment.velocity_body = x.segment<3>(3);
    moment.rate_body = now.rate;
    moment.force_body = now.force;
    moments.push_back(moment);
  }
  return moments;
}

Sensors::Sensors(const SensorErrors& errors, std::uint64_t seed) : errors_(errors), generator_(seed) {
  gyro_bias = draw3(errors.gyro_bias);
  force_bias = draw3(errors.force_bias);
  pitot_bias_ = draw(errors.pitot_bias);
  barometer_bias_ = draw(errors.barometer_bias);
  field_bias_ = draw3(errors.field_bias);
}

double Sensors::draw(double sigma) { return sigma * std::normal_distribution<double>()(generator_); }

Eigen::Vector3d Sensors::draw3(double sigma) {
  const double x = draw(sigma), y = draw(sigma), z = draw(sigma);
  return {x, y, z};
}

void Sensors::feed(StateSource& to, const Moment& moment) {
  to.on(ImuSample{moment.t_ns, moment.rate_body + gyro_bias + draw3(errors_.gyro_noise),
                  moment.force_body + force_bias + draw3(errors_.force_noise)});
  if (count_++ % 4 != 0) return;
  to.on(PitotSample{moment.t_ns,
                    moment.velocity_body.x() + pitot_bias_ + extra_pitot_mps + draw(errors_.pitot_noise)});
  const double z = moment.T_world_body.translation().z();
  to.on(BarometerSample{moment.t_ns, z + barometer_bias_ + draw(errors_.barometer_noise)});
  const Eigen::Vector3d field_world = 48 * Eigen::Vector3d(0, std::cos(67 * degree), -std::sin(67 * degree));
  to.on(MagnetometerSample{moment.t_ns, moment.T_world_body.linear().transpose() * field_world + field_bias_ +
                                            draw3(errors_.field_noise)});
}

void start_at(StartConfig& start, const Moment& truth) {
  const Eigen::Matrix3d attitude = truth.T_world_body.linear();
  start.in_flight = true;
  start.position_world_m = truth.T_world_body.translation();
  start.velocity_body_mps = truth.velocity_body;
  start.yaw_rad = std::atan2(attitude(1, 0), attitude(0, 0));
  start.pitch_rad = std::asin(attitude(2, 0));
  start.roll_rad = std::atan2(attitude(2, 1), attitude(2, 2));
}

Vector12d error_of(const State& estimate, const Moment& truth, const Eigen::Vector3d& gyro_bias) {
  const Eigen::AngleAxisd apart(
      Eigen::Matrix3d(estimate.T_world_body.linear().transpose() * truth.T_world_body.linear()));
  Vector12d error;
  error << apart.angle() * apart.axis(), truth.velocity_body - estimate.velocity_body_mps,
      truth.T_world_body.translation() - estimate.T_world_body.translation(),
      gyro_bias - estimate.gyro_bias_radps;
  return error;
}

}  // namespace understory::test
