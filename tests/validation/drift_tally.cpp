#include "tests/validation/drift_tally.hpp"

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

void DriftTally::add(const std::vector<Drift>& drifts) {
  for (const Drift& drift : drifts) {
    total_m.push_back(drift.total_m());
    across_m.push_back(std::abs(drift.along_across_m.y()));
    squared_sum_m2 += drift.total_m() * drift.total_m();
    stated_squared_sum_m2 += drift.stated_sigma_m * drift.stated_sigma_m;
  }
}

void DriftTally::add(const DriftTally& other) {
  total_m.insert(total_m.end(), other.total_m.begin(), other.total_m.end());
  across_m.insert(across_m.end(), other.across_m.begin(), other.across_m.end());
  squared_sum_m2 += other.squared_sum_m2;
  stated_squared_sum_m2 += other.stated_squared_sum_m2;
}

double DriftTally::quantile_m(double share) const { return quantile(total_m, share); }

double DriftTally::across_quantile_m(double share) const { return quantile(across_m, share); }

double DriftTally::rms_m() const { return std::sqrt(squared_sum_m2 / static_cast<double>(total_m.size())); }

double DriftTally::stated_rms_m() const {
  return std::sqrt(stated_squared_sum_m2 / static_cast<double>(total_m.size()));
}

double DriftTally::over_stated() const { return std::sqrt(squared_sum_m2 / stated_squared_sum_m2); }

}  // namespace understory
