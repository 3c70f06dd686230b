#include <gtest/gtest.h>

#include <cmath>

#include "estimation/filter.hpp"
#include "simulated_flight.hpp"

/// Corrections from earlier moments: GPS, 0.2 s late, and obstacles seen again.
namespace understory::test {
namespace {

constexpr std::size_t late = 40;  // IMU samples, 0.2 s

/// A dodge from steady flight on: a velocity of 0.2 s ago is wrong by up to 3 m/s.
std::vector<Moment> dodging() {
  std::vector<Moment> flight = fly(dodge(), 3.2);
  flight.erase(flight.begin(), flight.begin() + 160);
  return flight;
}

/// Knows everything but its velocity, and has nothing but inertial sensors to keep it.
FilterConfig wrong_about_velocity(const Moment& truth, const Eigen::Vector3d& error_body, double sigma_mps) {
  FilterConfig config;
  StartConfig& start = config.start;
  start_at(start, truth);
  start.velocity_body_mps -= error_body;
  start.velocity_sigma_mps = sigma_mps;
  start.tilt_sigma_rad = start.yaw_sigma_rad = start.gyro_bias_sigma_radps = 0;
  config.states.accelerometer_bias = false;
  config.gyro_noise_radps_rthz = config.gyro_bias_walk_rthz = config.accelerometer_noise_mps2_rthz = 0;
  config.sideslip.model = SideslipModel::off;
  config.angle_of_attack.enabled = false;
  return config;
}

ImuSample exact_imu(const Moment& truth) { return {truth.t_ns, truth.rate_body, truth.force_body}; }

Eigen::Vector3d velocity_world(const Moment& truth) {
  return truth.T_world_body.linear() * truth.velocity_body;
}

Eigen::Vector3d velocity_error_world(const Filter& filter, const Moment& truth) {
  return velocity_world(truth) - filter.state().T_world_body.linear() * filter.state().velocity_body_mps;
}

/// Without process noise every exact sample weighs alike: after n of them the error is the first one times
/// s^2 / (s^2 + n p^2), with s of a sample and p of the start. A correction counted twice would leave less,
/// or overshoot.
TEST(LateGps, ShrinksAVelocityErrorAsTheMeanOfItsSamplesDoes) {
  const std::vector<Moment> flight = dodging();
  const Eigen::Vector3d error(0.8, -0.5, 0.3);
  FilterConfig config = wrong_about_velocity(flight.front(), error, 0.6);
  Filter filter(config);
  const double at_first = error.norm(), prior = 0.36, sample = config.gps.sigma_mps * config.gps.sigma_mps;
  int taken = 0;
  for (std::size_t i = 0; i < flight.size(); ++i) {
    filter.on(exact_imu(flight[i]));
    if (i < late || i % 10 != 0) continue;  // 20 Hz, so that several speak of before the first correction
    const Moment& then = flight[i - late];
    filter.on(GpsSample{then.t_ns, then.T_world_body.translation(), velocity_world(then)});
    ++taken;
    EXPECT_NEAR(velocity_error_world(filter, flight[i]).norm(), at_first * sample / (sample + taken * prior),
                0.02)
        << "after sample " << taken;
    EXPECT_NEAR(filter.state().covariance(velocity_block, velocity_block),
                prior * sample / (sample + taken * prior), 1e-4);
  }
  EXPECT_GT(taken, 40);
}

TEST(Resightings, ShrinkAVelocityErrorAsTheMeanOfTheirDisplacementsDoes) {
  const std::vector<Moment> flight = dodging();
  const Eigen::Vector3d error(0.8, -0.5, 0.3);
  Filter filter(wrong_about_velocity(flight.front(), error, 0.6));
  constexpr std::size_t interval = 80;  // 0.4 s between the sightings, known 50 ms after the second
  constexpr double interval_s = 0.4, sigma_m = 0.2;
  const double sample = sigma_m * sigma_m / (interval_s * interval_s), prior = 0.36;
  const Eigen::Vector2d at_first = (flight.front().T_world_body.linear() * error).head<2>();
  int taken = 0;
  for (std::size_t i = 0; i < flight.size(); ++i) {
    filter.on(exact_imu(flight[i]));
    if (i < interval + 10 || i % 10 != 0) continue;
    const Moment &later = flight[i - 10], &earlier = flight[i - 10 - interval];
    const auto misplaced = [&](const Moment& truth) -> Eigen::Vector2d {
      return (filter.state_at(truth.t_ns).T_world_body.translation() - truth.T_world_body.translation())
          .head<2>();
    };
    filter.on(ResightingSample{later.t_ns, earlier.t_ns, misplaced(later) - misplaced(earlier),
                               sigma_m * sigma_m * Eigen::Matrix2d::Identity()});
    ++taken;
    const Eigen::Vector2d expected = at_first * sample / (sample + taken * prior);
    EXPECT_LT((velocity_error_world(filter, flight[i]).head<2>() - expected).norm(), 0.02)
        << "after resighting " << taken;
  }
  EXPECT_GT(taken, 35);
}

/// Moving air: the pitot feels it, GPS does not. `aided`: with GPS.
Filter through_wind(const std::vector<Moment>& flight, const Eigen::Vector3d& wind_world, bool aided) {
  FilterConfig config = wrong_about_velocity(flight.front(), Eigen::Vector3d::Zero(), 0.5);
  config.states.wind = true;
  config.states.pitot_bias = false;
  Filter filter(config);
  for (std::size_t i = 0; i < flight.size(); ++i) {
    filter.on(exact_imu(flight[i]));
    const Eigen::Vector3d air =
        flight[i].velocity_body - flight[i].T_world_body.linear().transpose() * wind_world;
    if (i % 4 == 0) filter.on(PitotSample{flight[i].t_ns, air.x()});
    if (!aided || i < late || i % 40 != 0) continue;
    const Moment& then = flight[i - late];
    filter.on(GpsSample{then.t_ns, then.T_world_body.translation(), velocity_world(then)});
  }
  return filter;
}

TEST(LateGps, TellsTheWindFromTheAircraftsOwnVelocity) {
  const std::vector<Moment> flight = dodging();
  const Eigen::Vector3d wind(3, -1.5, 0);
  const Filter alone = through_wind(flight, wind, false), aided = through_wind(flight, wind, true);
  EXPECT_LT(velocity_error_world(aided, flight.back()).norm(), 0.15);
  EXPECT_LT((aided.state().wind_world_mps - wind.head<2>()).norm(), 0.3);
  EXPECT_LT(aided.state().covariance(wind_block, wind_block),
            alone.state().covariance(wind_block, wind_block));
}

}  // namespace
}  // namespace understory::test
