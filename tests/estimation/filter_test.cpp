#include "estimation/filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "estimation/gate.hpp"
#include "estimation/measurements.hpp"
#include "simulated_flight.hpp"

namespace understory::test {
namespace {

/// A steady coordinated turn in closed form: bank phi, speed V, turn rate g tan(phi) / V, the force normal to
/// the path.
struct Turn {
  double bank_rad = M_PI / 3, speed_mps = 12, alpha_rad = 0.3;
  double rate_radps() const { return 9.81 * std::tan(bank_rad) / speed_mps; }
  Moment at(std::int64_t t_ns) const {
    const double yaw = rate_radps() * 1e-9 * static_cast<double>(t_ns), radius = speed_mps / rate_radps();
    Moment moment;
    moment.t_ns = t_ns;
    moment.T_world_body.translation() =
        Eigen::Vector3d(radius * std::sin(yaw), radius * (1 - std::cos(yaw)), 30);
    // A left turn banks left: negative about x. The wing stands alpha above the path, about its own y.
    const Eigen::Matrix3d path = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(-bank_rad, Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
    const Eigen::Matrix3d wing = Eigen::AngleAxisd(-alpha_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    const Eigen::Matrix3d attitude = path * wing;
    moment.T_world_body.linear() = attitude;
    moment.velocity_body = wing.transpose() * Eigen::Vector3d(speed_mps, 0, 0);
    moment.rate_body = attitude.transpose() * Eigen::Vector3d(0, 0, rate_radps());
    const Eigen::Vector3d inward(-std::sin(yaw), std::cos(yaw), 0);
    moment.force_body =
        attitude.transpose() * (speed_mps * rate_radps() * inward + Eigen::Vector3d(0, 0, 9.81));
    return moment;
  }
};

TEST(Filter, FollowsACoordinatedTurnInClosedForm) {
  for (const double bank : {-1.0, 0.5, M_PI / 3}) {
    Turn turn;
    turn.bank_rad = bank;
    FilterConfig config;
    start_at(config.start, turn.at(0));
    config.angle_of_attack.enabled = false;  // the closed form chooses its angle of attack freely,
    config.sideslip.model =
        SideslipModel::zero;  // and has no winglets: its sideslip is zero, whatever the turn rate
    Filter filter(config);
    Sensors sensors(SensorErrors::none(), 1);
    for (std::int64_t t_ns = 0; t_ns <= 5'000'000'000; t_ns += 5'000'000) sensors.feed(filter, turn.at(t_ns));
    const Vector12d error = error_of(filter.state(), turn.at(5'000'000'000), sensors.gyro_bias);
    EXPECT_LT(error.head<3>().norm(), 1e-3);
    EXPECT_LT(error.segment<3>(3).norm(), 1e-3);
    EXPECT_LT(error.segment<3>(6).norm(), 1e-2) << "over 60 m, bank " << bank;
  }
}

TEST(Filter, WithoutNoiseFollowsADodgeNearlyExactly) {
  FilterConfig config;
  config.altitude.sigma_m = 2;
  Filter filter(config);
  Sensors sensors(SensorErrors::none(), 1);
  double worst_position = 0, worst_velocity = 0, worst_attitude = 0;
  // The catapult fires, and lets go, midway between two samples: where it does not, up to half a sample of
  // its push, 0.12 m/s, is lost or counted twice at either end, which is no fault of the filter.
  Launch midway;
  midway.rest_s = 0.2525;
  for (const Moment& moment : fly(dodge(), 3.2, midway)) {
    sensors.feed(filter, moment);
    if (!filter.launched()) continue;
    const Vector12d error = error_of(filter.state(), moment, sensors.gyro_bias);
    worst_attitude = std::max(worst_attitude, error.head<3>().norm());
    worst_velocity = std::max(worst_velocity, error.segment<3>(3).norm());
    worst_position = std::max(worst_position, error.segment<3>(6).norm());
  }
  // What is left is the sampling of the stroke at 200 Hz: 48 m/s^2 for half a sample at each end, 0.24 m/s,
  // until the pitot has corrected it.
  EXPECT_LT(worst_velocity, 0.24);
  EXPECT_LT(worst_position, 0.15);
  EXPECT_LT(worst_attitude, 0.01);
}

TEST(Filter, RecoversADodgeFromNoisySamples) {
  const std::vector<Moment> flight = fly(dodge(), 3.2);
  double flown_m = 0;
  for (const Moment& moment : flight) flown_m += 0.005 * moment.velocity_body.norm();
  for (int seed = 0; seed < 20; ++seed) {
    Filter filter({});
    Sensors sensors({}, seed);
    for (const Moment& moment : flight) sensors.feed(filter, moment);
    const Vector12d error = error_of(filter.state(), flight.back(), sensors.gyro_bias);
    EXPECT_LT(error.head<3>().norm(), 0.06);
    EXPECT_LT(error.segment<3>(3).norm(), 0.8);
    EXPECT_LT(error.segment<3>(6).norm(), 1.2);  // over 40 m
    EXPECT_LT(error.tail<3>().norm(), 0.004);    // bias of 0.0087 rms per axis found at rest
    EXPECT_NEAR(filter.state().distance_flown_m, flown_m, 1.0);
  }
}

TEST(Filter, ThePapersStatesFollowTheDodgeToo) {
  const std::vector<Moment> flight = fly(dodge(), 3.2);
  FilterConfig config;
  config.model = FilterModel::angular_rate;
  Filter filter(config);
  SensorErrors errors;
  errors.gyro_bias = 0;
  Sensors sensors(errors, 3);
  for (const Moment& moment : flight) {
    sensors.feed(filter, moment);
    EXPECT_LT((filter.state().angular_rate_body_radps - moment.rate_body).norm(), 0.1);
  }
  EXPECT_LT(error_of(filter.state(), flight.back(), sensors.gyro_bias).segment<3>(6).norm(), 1.2);
  EXPECT_EQ(filter.state().gyro_bias_radps.norm(), 0);
}

TEST(Filter, DetectsTheLaunchOnTheSecondSampleOfTheStroke) {
  Filter filter({});
  Sensors sensors({}, 5);
  for (const Moment& moment : fly(straight(), 0.5)) {
    sensors.feed(filter, moment);
    // The stroke begins after 0.250 s; 0.255 and 0.260 are its first two samples.
    EXPECT_EQ(filter.launched(), moment.t_ns >= 260'000'000);
    const Eigen::Vector3d moved =
        filter.state().T_world_body.translation() - moment.T_world_body.translation();
    if (!filter.launched()) {
      EXPECT_LT(moved.norm(), 0.002);
    }
  }
  EXPECT_EQ(filter.launch_t_ns(), 260'000'000);
}

TEST(Filter, HandlingWithoutAStrokeIsNoLaunch) {
  Filter filter({});
  std::mt19937_64 generator(4);
  std::normal_distribution<double> shake(0, 4);
  for (std::int64_t t_ns = 0; t_ns < 1'000'000'000; t_ns += 5'000'000) {
    const Eigen::Vector3d force(2 + shake(generator), shake(generator), 9.6 + shake(generator));
    filter.on(ImuSample{t_ns, Eigen::Vector3d::Zero(), force});
  }
  EXPECT_FALSE(filter.launched());
}

/// A window of samples at rest on a slope, 200 a second, with a gyro's bias and noise; `shake` on top.
bool rests(const Eigen::Vector3d& gyro_bias, double gyro_noise, const Eigen::Vector3d& shake_radps,
           const RestConfig& config = {}) {
  RestWindow window(config, 9.81);
  std::mt19937_64 generator(7);
  std::normal_distribution<double> noise(0, 1);
  bool is_rest = false;
  for (int i = 0; i < 20; ++i) {
    ImuSample sample;
    sample.t_ns = i * std::int64_t{5'000'000};
    sample.specific_force_body_mps2 = {3.8, 0.05 * noise(generator), 9.04};
    for (int axis = 0; axis < 3; ++axis) {
      sample.angular_rate_body_radps[axis] = gyro_bias[axis] + gyro_noise * noise(generator);
      sample.angular_rate_body_radps[axis] += shake_radps[axis] * std::sin(0.6 * i);
    }
    is_rest = window.rests_with(sample);
    EXPECT_TRUE(!is_rest || i >= 4);  // fewer samples tell no variance
  }
  return is_rest;
}

TEST(Filter, AConstantGyroBiasIsNoMotion) {
  const Eigen::Vector3d still = Eigen::Vector3d::Zero();
  EXPECT_TRUE(rests(still, 0.0024, still));
  EXPECT_TRUE(rests({0.03, -0.03, 0.02}, 0.0024, still));  // 0.047 rad/s, more than a consumer gyro's
  EXPECT_FALSE(rests(still, 0.0024, {0, 0.05, 0}));        // carried by hand
  EXPECT_FALSE(rests({0.2, 0, 0}, 0.0024, still));         // turned steadily
  RestConfig rough;
  rough.rate_tolerance_radps = 0.15;
  EXPECT_TRUE(rests({0.08, 0.05, -0.03}, 0.0024, still, rough));
}

TEST(Filter, LearnsWhatThePropellerDoesToTheBarometer) {
  constexpr double wash_m_per_n = 0.4;
  for (const bool knows : {true, false}) {
    FilterConfig config;
    config.start.in_flight = true;
    config.start.pitch_rad = 0;
    config.start.position_world_m = {0, 0, 4};
    config.start.velocity_body_mps = {12, 0, 0};
    config.sideslip.model = SideslipModel::off;
    config.heading.enabled = false;
    config.altitude.wash_sigma_m_per_n = knows ? wash_m_per_n : 0;
    Filter filter(config);
    std::mt19937_64 generator(3);
    std::normal_distribution<double> noise(0, 0.3);
    for (std::int64_t t_ns = 0; t_ns <= 5'000'000'000; t_ns += 5'000'000) {
      const double thrust_n = t_ns / 700'000'000 % 2 == 0 ? 1 : 4;  // level, now weak, now strong
      filter.on(ImuSample{t_ns, Eigen::Vector3d::Zero(), {0, 0, 9.81}});
      filter.on(ThrustSample{t_ns, thrust_n});
      if (t_ns % 20'000'000 != 0) continue;
      filter.on(PitotSample{t_ns, 12});
      filter.on(BarometerSample{t_ns, 4 + wash_m_per_n * thrust_n + noise(generator)});
    }
    if (knows) {
      EXPECT_NEAR(filter.state().barometer_wash_m_per_n, wash_m_per_n, 0.08);
      EXPECT_NEAR(filter.state().altitude_m, 4, 0.3);
    } else {
      EXPECT_EQ(filter.state().barometer_wash_m_per_n, 0);
      EXPECT_GT(filter.state().altitude_m, 4.4);  // it believes the barometer
    }
  }
}

TEST(Filter, APitotBiasOfThreeMetresPerSecondMovesTheEstimate) {
  const std::vector<Moment> flight = fly(straight(), 4.0);
  FilterConfig believing;
  believing.distrust.exclude = false;
  Filter filter(believing);
  Sensors sensors({}, 6);
  sensors.extra_pitot_mps = 3;
  for (const Moment& moment : flight) sensors.feed(filter, moment);
  const double error = filter.state().velocity_body_mps.x() - flight.back().velocity_body.x();
  EXPECT_GT(error, 0.5);  // the inertial sensors, which are better, resist it
  EXPECT_LT(error, 3.5);
}

TEST(Filter, SampleOutliersAreKeptOut) {
  const std::vector<Moment> flight = fly(straight(), 2.0);
  Filter clean({}), spiked({});
  Sensors of_clean({}, 7), of_spiked({}, 7);
  for (std::size_t i = 0; i < flight.size(); ++i) {
    of_clean.feed(clean, flight[i]);
    of_spiked.feed(spiked, flight[i]);
    if (i > 150 && i % 20 == 1) {
      spiked.on(PitotSample{flight[i].t_ns, 40.0});
      spiked.on(BarometerSample{flight[i].t_ns, -500.0});
    }
  }
  EXPECT_LT((clean.state().velocity_body_mps - spiked.state().velocity_body_mps).norm(), 1e-12);
  EXPECT_LT((clean.state().T_world_body.translation() - spiked.state().T_world_body.translation()).norm(),
            1e-12);
}

TEST(Filter, NonsenseIsIgnoredAndGapsAreSurvived) {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinite = std::numeric_limits<double>::infinity();
  const std::vector<Moment> flight = fly(straight(), 3.0);
  Filter filter({});
  Sensors sensors({}, 8);
  for (std::size_t i = 0; i < flight.size(); ++i) {
    const std::int64_t t_ns = flight[i].t_ns;
    if (i > 300 && i < 400) continue;  // half a second of silence
    sensors.feed(filter, flight[i]);
    filter.on(ImuSample{t_ns + 1, Eigen::Vector3d(nan, 0, 0), Eigen::Vector3d::Zero()});
    filter.on(ImuSample{t_ns, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});  // not newer
    filter.on(PitotSample{t_ns, infinite});
    filter.on(BarometerSample{t_ns, nan});
    filter.on(MagnetometerSample{t_ns, Eigen::Vector3d(0, nan, 0)});
    filter.on(MagnetometerSample{t_ns, Eigen::Vector3d::Zero()});
  }
  filter.on(
      ImuSample{flight.back().t_ns + 5'000'000, Eigen::Vector3d(1e300, 0, 0), Eigen::Vector3d(0, -1e300, 0)});
  EXPECT_TRUE(filter.state().covariance.allFinite());
  EXPECT_TRUE(filter.state().T_world_body.matrix().allFinite());
  EXPECT_LT((filter.state().velocity_body_mps - flight.back().velocity_body).norm(), 5);
}

TEST(Filter, StateAtInterpolatesTheLastSecond) {
  const std::vector<Moment> flight = fly(dodge(), 2.0);
  Filter filter({});
  Sensors sensors(SensorErrors::none(), 9);
  std::vector<State> recorded;
  for (const Moment& moment : flight) {
    sensors.feed(filter, moment);
    recorded.push_back(filter.state());
  }
  const std::size_t last = recorded.size() - 1;
  const State& a = recorded[last - 11];
  const State& b = recorded[last - 10];
  const State middle = filter.state_at(a.t_ns + 2'500'000);
  EXPECT_EQ(middle.t_ns, a.t_ns + 2'500'000);
  const Eigen::Vector3d between = 0.5 * (a.T_world_body.translation() + b.T_world_body.translation());
  EXPECT_LT((middle.T_world_body.translation() - between).norm(), 1e-12);
  const Eigen::Quaterniond halfway =
      Eigen::Quaterniond(a.T_world_body.linear()).slerp(0.5, Eigen::Quaterniond(b.T_world_body.linear()));
  EXPECT_LT(halfway.angularDistance(Eigen::Quaterniond(middle.T_world_body.linear())), 1e-7);
  EXPECT_LT((filter.state_at(a.t_ns).T_world_body.matrix() - a.T_world_body.matrix()).norm(), 1e-14);
  EXPECT_EQ(filter.state_at(recorded[last].t_ns + 2'000'000'000).t_ns, recorded[last].t_ns);
  EXPECT_EQ(filter.state_at(0).t_ns, recorded[last].t_ns - 1'000'000'000);
}

TEST(Gate, QuantilesAgreeWithTables) {
  EXPECT_NEAR(chi_square_quantile(0.95, 1), 3.841, 1e-3);
  EXPECT_NEAR(chi_square_quantile(0.999, 1), 10.828, 1e-3);
  EXPECT_NEAR(chi_square_quantile(0.95, 2), 5.991, 1e-3);
  EXPECT_NEAR(chi_square_quantile(0.99, 3), 11.345, 1e-3);
}

TEST(Gate, RefusesOutliersButNotForEver) {
  Gate gate(10, 0.1, Distrust::believe);
  EXPECT_TRUE(gate.admits(9, 0));
  EXPECT_FALSE(gate.admits(11, 20'000'000));
  EXPECT_TRUE(gate.admits(1, 40'000'000));  // it agrees again: patience starts anew
  EXPECT_FALSE(gate.admits(11, 60'000'000));
  EXPECT_FALSE(gate.admits(11, 160'000'000));
  EXPECT_TRUE(gate.admits(11, 170'000'000));
  EXPECT_FALSE(gate.admits(std::numeric_limits<double>::quiet_NaN(), 180'000'000));
}

TEST(Gate, AFaultySensorStaysOutUntilItHasAgreedAsLong) {
  Gate gate(10, 0.1, Distrust::exclude);
  const auto at = [&](double squared, std::int64_t t_ms) { return gate.admits(squared, t_ms * 1'000'000); };
  EXPECT_TRUE(at(1, 0));
  EXPECT_FALSE(at(50, 20));
  EXPECT_FALSE(gate.faulty());  // a single outlier is no fault
  EXPECT_FALSE(at(50, 130));
  EXPECT_TRUE(gate.faulty());
  EXPECT_FALSE(at(1, 140));  // one agreement does not end a fault
  EXPECT_FALSE(at(50, 200));
  EXPECT_FALSE(at(1, 220));
  EXPECT_FALSE(at(1, 320));
  EXPECT_TRUE(at(1, 330));
  EXPECT_FALSE(gate.faulty());
  EXPECT_EQ(gate.newest(), 1);
}

}  // namespace
}  // namespace understory::test
