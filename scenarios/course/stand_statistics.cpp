#include "scenarios/course/stand_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <random>

#include "scenarios/statistics/statistics.hpp"

namespace understory {
namespace {

using Curve = std::vector<double>;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// L(r) - r of every stand that has one.
std::vector<Curve> curves_of(const std::vector<Stand>& stands) {
  std::vector<Curve> curves;
  for (const Stand& stand : stands)
    if (stand.places.size() > 1) curves.push_back(ripley_l_minus_r(stand));
  return curves;
}

std::vector<double> values_at(const std::vector<Curve>& curves, std::size_t radius) {
  std::vector<double> values;
  for (const Curve& curve : curves) values.push_back(curve[radius]);
  return values;
}

/// Studentised distance between the means of the first `count` curves and the others: squared differences
/// over their variances, summed over the distances.
double distance_between(const std::vector<Curve>& curves, std::size_t count) {
  double sum = 0;
  for (std::size_t radius = 0; radius < std::size(ripley_radii_m); ++radius) {
    double mean[2] = {0, 0}, square[2] = {0, 0};
    const double size[2] = {static_cast<double>(count), static_cast<double>(curves.size() - count)};
    for (std::size_t i = 0; i < curves.size(); ++i) {
      mean[i >= count] += curves[i][radius];
      square[i >= count] += curves[i][radius] * curves[i][radius];
    }
    double variance = 0;
    for (int group = 0; group < 2; ++group) {
      mean[group] /= size[group];
      variance += std::max(0.0, square[group] / size[group] - mean[group] * mean[group]) / (size[group] - 1);
    }
    if (variance > 0) sum += (mean[0] - mean[1]) * (mean[0] - mean[1]) / variance;
  }
  return sum;
}

std::vector<double> diameters_in(const std::vector<Stand>& stands) {
  std::vector<double> all;
  for (const Stand& stand : stands) all.insert(all.end(), stand.diameters_m.begin(), stand.diameters_m.end());
  std::ranges::sort(all);
  return all;
}

}  // namespace

std::vector<double> ripley_l_minus_r(const Stand& stand) {
  Curve sums(std::size(ripley_radii_m), 0);
  const Eigen::Vector2d size = stand.window.sizes();
  const double area = size.prod(), count = static_cast<double>(stand.places.size());
  for (std::size_t i = 0; i < stand.places.size(); ++i)
    for (std::size_t j = i + 1; j < stand.places.size(); ++j) {
      const Eigen::Vector2d apart = (stand.places[i] - stand.places[j]).cwiseAbs();
      const double distance_m = apart.norm();
      if (distance_m > *std::prev(std::end(ripley_radii_m))) continue;
      const double weight = 2 / (size - apart).prod();
      for (std::size_t radius = 0; radius < sums.size(); ++radius)
        if (distance_m <= ripley_radii_m[radius]) sums[radius] += weight;
    }
  for (std::size_t radius = 0; radius < sums.size(); ++radius) {
    const double k = sums[radius] * area * area / (count * (count - 1));
    sums[radius] = count > 1 ? std::sqrt(k / std::numbers::pi) - ripley_radii_m[radius] : not_a_number;
  }
  return sums;
}

double clark_evans_index(const Stand& stand) {
  const double count = static_cast<double>(stand.places.size());
  if (count < 2) return not_a_number;
  double sum_m = 0;
  for (std::size_t i = 0; i < stand.places.size(); ++i) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < stand.places.size(); ++j)
      if (j != i) nearest_m = std::min(nearest_m, (stand.places[i] - stand.places[j]).norm());
    sum_m += nearest_m;
  }
  const double area = stand.window.volume(), rim_m = 2 * stand.window.sizes().sum();
  return sum_m / count /
         (0.5 * std::sqrt(area / count) + (0.0514 + 0.041 / std::sqrt(count)) * rim_m / count);
}

StandFigures figures_of(const std::vector<Stand>& stands) {
  StandFigures figures;
  figures.stands = static_cast<int>(stands.size());
  double area_ha = 0, indices = 0;
  int with_index = 0;
  for (const Stand& stand : stands) {
    area_ha += 1e-4 * stand.window.volume();
    figures.stems += static_cast<std::int64_t>(stand.places.size());
    for (const double d : stand.diameters_m) figures.basal_area_m2_per_ha += 0.25 * std::numbers::pi * d * d;
    if (stand.places.size() < 2) continue;
    indices += clark_evans_index(stand);
    ++with_index;
  }
  figures.stems_per_ha = static_cast<double>(figures.stems) / area_ha;
  figures.basal_area_m2_per_ha /= area_ha;
  figures.clark_evans = with_index > 0 ? indices / with_index : not_a_number;
  const std::vector<double> diameters = diameters_in(stands);
  figures.median_m = quantile(diameters, 0.5);
  figures.upper_tenth_m = quantile(diameters, 0.9);
  figures.largest_m = diameters.empty() ? 0 : diameters.back();
  const std::vector<Curve> curves = curves_of(stands);
  for (std::size_t radius = 0; radius < std::size(ripley_radii_m); ++radius) {
    const std::vector<double> values = values_at(curves, radius);
    figures.l_minus_r.push_back(values.empty() ? not_a_number : mean_of(values));
    figures.low.push_back(values.empty() ? not_a_number : quantile(values, 0.025));
    figures.high.push_back(values.empty() ? not_a_number : quantile(values, 0.975));
  }
  return figures;
}

StandTests compare(const std::vector<Stand>& one, const std::vector<Stand>& other) {
  StandTests tests;
  const std::vector<double> a = diameters_in(one), b = diameters_in(other);
  if (a.empty() || b.empty()) return tests;
  const double size_a = static_cast<double>(a.size()), size_b = static_cast<double>(b.size());
  for (const std::vector<double>* sample : {&a, &b})
    for (const double value : *sample) {
      const auto share = [&](const std::vector<double>& sorted, double size) {
        return static_cast<double>(std::ranges::upper_bound(sorted, value) - sorted.begin()) / size;
      };
      tests.ks_distance = std::max(tests.ks_distance, std::abs(share(a, size_a) - share(b, size_b)));
    }
  // Kolmogorov's distribution with Stephens' correction for finite samples (1970, J. R. Stat. Soc. B 32,
  // 115).
  const double root = std::sqrt(size_a * size_b / (size_a + size_b));
  const double scaled = (root + 0.12 + 0.11 / root) * tests.ks_distance;
  double p = 0;
  for (int k = 1; k <= 100; ++k) p += (k % 2 == 1 ? 2 : -2) * std::exp(-2 * k * k * scaled * scaled);
  tests.ks_p = scaled < 0.2 ? 1 : std::clamp(p, 0.0, 1.0);

  std::vector<Curve> curves = curves_of(one);
  const std::size_t count = curves.size();
  const std::vector<Curve> others = curves_of(other);
  curves.insert(curves.end(), others.begin(), others.end());
  if (count < 2 || others.size() < 2) return tests;
  const double seen = distance_between(curves, count);
  constexpr int permutations = 999;
  int at_least = 0;
  std::mt19937_64 generator(1);
  for (int i = 0; i < permutations; ++i) {
    for (std::size_t last = curves.size() - 1; last > 0; --last)
      std::swap(curves[last], curves[generator() % (last + 1)]);
    at_least += distance_between(curves, count) >= seen;
  }
  tests.k_p = (1.0 + at_least) / (1 + permutations);
  return tests;
}

}  // namespace understory
