#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "estimation/filter.hpp"
#include "simulated_flight.hpp"

/// When a sensor fails in flight, the filter reports it, goes on, and states a larger uncertainty.
namespace understory::test {
namespace {

/// Passes samples on to a filter, changed or withheld. Times are seconds since the first sample.
struct Tampered : StateSource {
  explicit Tampered(const FilterConfig& config) : filter(config) {}
  static double at(std::int64_t t_ns) { return 1e-9 * static_cast<double>(t_ns); }
  void on(const Sample& sample) override {
    std::visit([this](const auto& one) { on(one); }, sample);
  }
  void on(const ImuSample& sample) {
    if (!imu_lost(at(sample.t_ns))) filter.on(sample);
  }
  void on(const PitotSample& sample) {
    if (pitot_lost(at(sample.t_ns))) return;
    filter.on(PitotSample{sample.t_ns, pitot(at(sample.t_ns), sample.airspeed_mps)});
  }
  void on(const BarometerSample& sample) {
    filter.on(BarometerSample{sample.t_ns, barometer(at(sample.t_ns), sample.altitude_m)});
  }
  void on(const auto& sample) { filter.on(sample); }
  const State& state() const override { return filter.state(); }
  State state_at(std::int64_t t_ns) const override { return filter.state_at(t_ns); }

  Filter filter;
  std::function<bool(double)> imu_lost = [](double) { return false; };
  std::function<bool(double)> pitot_lost = [](double) { return false; };
  std::function<double(double, double)> pitot = [](double, double value) { return value; };
  std::function<double(double, double)> barometer = [](double, double value) { return value; };
};

constexpr int seeds = 40;
/// 99.9 % quantile of the mean of 40 chi-square variables with three degrees of freedom: chi2(120) / 40.
constexpr double nees_maximum = 173.6 / seeds;
constexpr double begin_s = 1.5, end_s = 5.0;  ///< of the faults: steady flight, then a dodge, then faster

/// Dodges after a second and again 3.5 s later. The catapult fires at no moment of the sampling in
/// particular: whenever it fired on a sample, all seeds would share one error of the launch speed.
std::vector<Moment> two_dodges(int seed) {
  const Manoeuvre once = dodge();
  Manoeuvre twice;
  twice.roll_rate = [once](double t) { return once.roll_rate(t) + once.roll_rate(t - 3.5); };
  twice.angle_of_attack = [once](double t) {
    return once.angle_of_attack(t) + once.angle_of_attack(t - 3.5) - once.angle_of_attack(0);
  };
  std::mt19937_64 generator(static_cast<std::uint64_t>(seed));
  std::uniform_real_distribution<double> uniform;
  Launch launch;
  launch.rest_s += 0.005 * uniform(generator);
  launch.speed_mps += 0.2 * uniform(generator);
  return fly(twice, 8.0, launch);
}

/// Over the seeds, at each IMU sample.
struct Course {
  static constexpr std::size_t samples = 1601;  // 8 s
  std::vector<double> error_mps = none(), sigma_mps = none(),
                      nees = none();  ///< velocity: root mean squares, and the mean NEES
  std::vector<double> sigma_z_m = none(), worst_altitude_m = none(), worst_climb_mps = none();
  std::vector<int> faulty = std::vector<int>(samples);  ///< seeds in which the aid is known to be
  double at(const std::vector<double>& of, double t_s) const { return of[index(t_s)]; }
  static std::vector<double> none() { return std::vector<double>(samples); }
  static std::size_t index(double t_s) { return static_cast<std::size_t>(std::lround(t_s / 0.005)); }
};

using Fault = std::function<void(Tampered&)>;

void observe(Course& course, std::size_t i, const State& state, const Moment& truth) {
  const Vector12d error = error_of(state, truth, Eigen::Vector3d::Zero());
  const Eigen::Vector3d velocity = error.segment<3>(velocity_block);
  const Eigen::Matrix3d spread = state.covariance.block<3, 3>(velocity_block, velocity_block);
  const double climb_mps = state.T_world_body.linear().row(2).dot(state.velocity_body_mps);
  const double true_climb_mps = truth.T_world_body.linear().row(2).dot(truth.velocity_body);
  course.error_mps[i] = std::hypot(course.error_mps[i], velocity.norm() / std::sqrt(seeds));
  course.sigma_mps[i] = std::hypot(course.sigma_mps[i], std::sqrt(spread.trace() / seeds));
  course.nees[i] += velocity.dot(spread.inverse() * velocity) / seeds;
  course.sigma_z_m[i] = std::hypot(
      course.sigma_z_m[i], std::sqrt(state.covariance(position_block + 2, position_block + 2) / seeds));
  const double altitude_error_m = state.altitude_m - truth.T_world_body.translation().z();
  course.worst_altitude_m[i] = std::max(course.worst_altitude_m[i], std::abs(altitude_error_m));
  course.worst_climb_mps[i] = std::max(course.worst_climb_mps[i], std::abs(climb_mps - true_climb_mps));
}

Course flown(const Fault& fault, Aid aid = Aid::airspeed) {
  Course course;
  for (int seed = 0; seed < seeds; ++seed) {
    const std::vector<Moment> flight = two_dodges(seed);
    Tampered tampered{FilterConfig{}};
    fault(tampered);
    Sensors sensors({}, static_cast<std::uint64_t>(300 + seed));
    for (std::size_t i = 0; i < Course::samples; ++i) {
      sensors.feed(tampered, flight[i]);
      observe(course, i, tampered.state(), flight[i]);
      course.faulty[i] += tampered.filter.faulty(aid);
    }
  }
  return course;
}

const Course& healthy() {
  static const Course course = flown([](Tampered&) {});
  return course;
}

bool failing(double t_s) { return t_s > begin_s && t_s < end_s; }

/// Dead reckoning's share: no pitot at all, and the filter told so.
const Course& without_pitot() {
  static const Course course = flown([](Tampered& tampered) { tampered.pitot_lost = failing; });
  return course;
}

/// A false pitot costs no more than none, even before the fault is known (root mean squares of the velocity's
/// error). Having none costs little here: for 3.5 s the inertial sensors keep what the pitot found.
void expect_no_worse_than_without_pitot(const Course& course) {
  for (double t_s = begin_s; t_s < 8; t_s += 0.05) {
    EXPECT_LT(course.at(course.error_mps, t_s),
              1.3 * without_pitot().at(without_pitot().error_mps, t_s) + 0.03)
        << t_s;
    EXPECT_LT(course.at(course.error_mps, t_s), 0.15) << t_s;
    EXPECT_LT(course.at(course.nees, t_s), nees_maximum) << t_s;
  }
  EXPECT_GT(course.at(course.sigma_mps, end_s), 1.1 * healthy().at(healthy().sigma_mps, end_s));
  EXPECT_EQ(course.faulty[Course::index(begin_s)], 0);
  EXPECT_EQ(course.faulty[Course::index(end_s + 0.5)], 0) << "the pitot is well again";
  EXPECT_LT(course.at(course.sigma_mps, 8), 1.1 * healthy().at(healthy().sigma_mps, 8));
}

TEST(Fault, NoneIsReportedInAHealthyFlight) {
  for (const int faulty : healthy().faulty) EXPECT_EQ(faulty, 0);
  for (double t_s = begin_s; t_s < 8; t_s += 0.05)
    EXPECT_LT(healthy().at(healthy().nees, t_s), nees_maximum) << t_s;
}

TEST(Fault, ABlockedPitotOrOneFiveMetresPerSecondTooFastIsLeftOutWithinHalfASecond) {
  for (const double share : {0.0, 1.0}) {
    const Course course = flown([&](Tampered& tampered) {
      tampered.pitot = [&](double t_s, double value) { return failing(t_s) ? share * (value + 5) : value; };
    });
    for (double t_s = begin_s + 0.5; t_s < end_s; t_s += 0.005)
      EXPECT_EQ(course.faulty[Course::index(t_s)], seeds) << (share > 0 ? "too fast" : "blocked");
    expect_no_worse_than_without_pitot(course);
  }
}

/// A frozen pitot is right until the speed changes. The dodge takes 1 m/s from 1.7 s to 2 s and the dive
/// after it adds 3.5 m/s until 4 s: around 3 s the true speed passes the frozen value, and nobody could tell.
TEST(Fault, AFrozenPitotIsLeftOutOnceTheSpeedHasChanged) {
  const Course course = flown([](Tampered& tampered) {
    tampered.pitot = [frozen = 0.0](double t_s, double value) mutable {
      if (!failing(t_s)) frozen = value;
      return frozen;
    };
  });
  EXPECT_EQ(course.faulty[Course::index(2.5)], seeds);
  for (double t_s = 4.0; t_s < end_s; t_s += 0.005) EXPECT_EQ(course.faulty[Course::index(t_s)], seeds);
  expect_no_worse_than_without_pitot(course);
}

/// During the roll and the pull of a dodge, where a guessed rate and force are wrong.
TEST(Fault, LostImuFramesAreCountedAndTheCovarianceCoversThem) {
  for (const double lost_s : {0.05, 0.1}) {
    for (const double from_s : {1.7, 2.0, 2.4}) {
      const double until_s = from_s + lost_s;
      const Course course = flown([&](Tampered& tampered) {
        tampered.imu_lost = [&](double t_s) { return t_s > from_s + 1e-4 && t_s < until_s - 1e-4; };
      });
      EXPECT_GT(course.at(course.sigma_mps, until_s), 3 * healthy().at(healthy().sigma_mps, until_s));
      for (double t_s = until_s; t_s < 8; t_s += 0.05)
        EXPECT_LT(course.at(course.nees, t_s), nees_maximum) << t_s << " lost from " << from_s;
      EXPECT_LT(course.at(course.error_mps, until_s), 0.3);
      EXPECT_LT(course.at(course.error_mps, until_s + 1), 0.1);
    }
    Tampered tampered{FilterConfig{}};
    tampered.imu_lost = [&](double t_s) {
      return std::fmod(t_s, 1.0) < lost_s - 1e-4 && std::fmod(t_s, 1.0) > 1e-4 && t_s > 1;
    };
    Sensors sensors({}, 1);
    for (const Moment& moment : two_dodges(1)) sensors.feed(tampered, moment);
    EXPECT_EQ(tampered.filter.imu_gaps(), 8) << "one in each second from the first to the eighth";
  }
}

/// A lasting offset, as if a door had opened. The altitude is then that of the odometry.
TEST(Fault, ABarometerThatStepsIsLeftOut) {
  const Course course = flown(
      [](Tampered& tampered) {
        tampered.barometer = [](double t_s, double value) { return t_s > begin_s ? value + 5 : value; };
      },
      Aid::altitude);
  for (double t_s = begin_s; t_s < 8; t_s += 0.005) {
    EXPECT_LT(course.at(course.worst_altitude_m, t_s), 0.6) << t_s;
    EXPECT_LT(course.at(course.worst_climb_mps, t_s), 0.25) << t_s;
    EXPECT_LT(course.at(course.nees, t_s), nees_maximum) << t_s;
    if (t_s > begin_s + 0.5) {
      EXPECT_EQ(course.faulty[Course::index(t_s)], seeds) << t_s;
    }
  }
  EXPECT_GT(course.at(course.sigma_z_m, 8), 1.15 * healthy().at(healthy().sigma_z_m, 8));
}

}  // namespace
}  // namespace understory::test
