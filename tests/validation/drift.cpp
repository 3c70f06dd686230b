#include "tests/validation/drift.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace understory {
namespace {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const double above = values[std::min(below + 1, values.size() - 1)];
  return std::lerp(values[below], above, place - std::floor(place));
}

}  // namespace

std::vector<Drift> drifts(const FlightTrace& flight, const std::vector<TrialMoment>& moments,
                          double sight_m) {
  const Eigen::Vector3d forward_body =
      (flight.rig.T_body_camera.linear() * Eigen::Vector3d::UnitZ()).normalized();
  std::vector<Drift> found;
  double next_s = flight.release_s() + 0.5;
  for (std::size_t seen = 0; seen < moments.size(); ++seen) {
    if (moments[seen].t_s() < next_s) continue;
    next_s += 0.05;
    const Eigen::Vector3d ahead_body = sight_m * forward_body;
    const Eigen::Vector3d point_world = moments[seen].truth.T_world_body * ahead_body;
    // Passed: the point no longer lies ahead along the course over ground.
    std::size_t passed = seen + 1;
    const auto ahead_m = [&](const TrialMoment& moment) {
      return (point_world - moment.truth.T_world_body.translation()).dot(moment.truth.velocity_world_mps);
    };
    while (passed < moments.size() && ahead_m(moments[passed]) > 0) ++passed;
    if (passed == moments.size()) break;
    const TrialMoment& then = moments[seen];
    const TrialMoment& now = moments[passed];
    const Eigen::Vector3d true_body = now.truth.T_world_body.inverse() * point_world;
    const Eigen::Vector3d remembered_body =
        now.estimate.T_world_body.inverse() * (then.estimate.T_world_body * ahead_body);
    const Eigen::Vector3d error_world = now.truth.T_world_body.linear() * (remembered_body - true_body);
    const Eigen::Vector2d course = now.truth.velocity_world_mps.head<2>().normalized();
    Drift& drift = found.emplace_back();
    drift.along_across_m = {error_world.head<2>().dot(course),
                            error_world.head<2>().dot(Eigen::Vector2d(-course.y(), course.x()))};
    drift.vertical_m = error_world.z();
    // The position error grows by the velocity's, which lasts: sigma of the difference is the interval times
    // the velocity's sigma, to first order (docs: the filter keeps no clone of its past).
    const double interval_s = now.t_s() - then.t_s();
    const auto velocity = now.estimate.covariance.block<3, 3>(velocity_block, velocity_block);
    drift.stated_sigma_m = interval_s * std::sqrt(velocity.trace());
  }
  return found;
}

void DriftTally::add(const std::vector<Drift>& drifts) {
  for (const Drift& drift : drifts) {
    total_m.push_back(drift.total_m());
    across_m.push_back(std::abs(drift.along_across_m.y()));
    squared_sum_m2 += drift.total_m() * drift.total_m();
    stated_squared_sum_m2 += drift.stated_sigma_m * drift.stated_sigma_m;
  }
}

double DriftTally::quantile_m(double share) const { return quantile(total_m, share); }

double DriftTally::across_quantile_m() const { return quantile(across_m, drift_share); }

double DriftTally::rms_m() const { return std::sqrt(squared_sum_m2 / static_cast<double>(total_m.size())); }

double DriftTally::stated_rms_m() const {
  return std::sqrt(stated_squared_sum_m2 / static_cast<double>(total_m.size()));
}

double DriftTally::over_stated() const { return std::sqrt(squared_sum_m2 / stated_squared_sum_m2); }

}  // namespace understory
