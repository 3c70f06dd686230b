#include <gtest/gtest.h>

#include <algorithm>

#include "estimation/filter.hpp"
#include "simulated_flight.hpp"

namespace understory::test {
namespace {

/// Distance between an obstacle that was seen 10 m ahead and its place by the estimate, when it is passed:
/// 95th percentile over seeds of sensor noise, metres.
double drift_m(const Manoeuvre& manoeuvre, const FilterConfig& config, int seeds = 60) {
  const std::vector<Moment> flight = fly(manoeuvre, 3.2);
  std::vector<double> drifts;
  for (int seed = 0; seed < seeds; ++seed) {
    Filter filter(config);
    Sensors sensors({}, 1000 + seed);
    std::vector<State> estimates;
    for (const Moment& moment : flight) {
      sensors.feed(filter, moment);
      estimates.push_back(filter.state());
    }
    for (const double seen_s : {1.5, 1.7, 1.9, 2.1, 2.3}) {
      const auto seen = static_cast<std::size_t>(seen_s / 0.005);
      std::size_t passed = seen;
      double flown = 0;
      while (passed + 1 < flight.size() && flown < 10) flown += flight[++passed].velocity_body.norm() * 0.005;
      const Eigen::Isometry3d true_motion = flight[seen].T_world_body.inverse() * flight[passed].T_world_body;
      const Eigen::Isometry3d motion =
          estimates[seen].T_world_body.inverse() * estimates[passed].T_world_body;
      drifts.push_back((true_motion.translation() - motion.translation()).norm());
    }
  }
  std::sort(drifts.begin(), drifts.end());
  return drifts[drifts.size() * 95 / 100];
}

TEST(Drift, OverTenMetresStaysBelowTwentyCentimetres) {
  const double level = drift_m(straight(), {}), dodging = drift_m(dodge(), {});
  RecordProperty("straight_m", std::to_string(level));
  RecordProperty("dodging_m", std::to_string(dodging));
  EXPECT_LT(level, 0.20);
  EXPECT_LT(dodging, 0.20);
}

TEST(Drift, SideslipFromLateralForceBeatsNoSideslip) {
  FilterConfig none;
  none.sideslip.model = SideslipModel::zero;
  none.sideslip.zero_sigma_mps = 0.5;
  none.distrust.exclude = false;  // otherwise the fault is detected and the pitot ignored
  EXPECT_LT(2 * drift_m(dodge(), {}), drift_m(dodge(), none));
}

TEST(Drift, DefaultsBeatTheOriginalInDodges) {
  EXPECT_LT(2 * drift_m(dodge(), {}), drift_m(dodge(), original_filter()));
}

}  // namespace
}  // namespace understory::test
