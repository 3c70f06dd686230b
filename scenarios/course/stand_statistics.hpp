#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace understory {

/// Stems in a rectangle of ground, m.
struct Stand {
  Eigen::AlignedBox2d window;
  std::vector<Eigen::Vector2d> places;
  std::vector<double> diameters_m;  ///< at 1.3 m height
};

/// Distances at which Ripley's K is computed, m.
inline constexpr double ripley_radii_m[]{0.5, 1, 1.5, 2, 3, 4, 5, 6, 8, 10};

/// Ripley's L(r) - r at these distances (Ripley 1977, J. R. Stat. Soc. B 39, 172), with the translation
/// correction for edges (Ohser & Stoyan 1981): 0 for independent places, above it for clusters. NaN for fewer
/// than two stems.
std::vector<double> ripley_l_minus_r(const Stand& stand);

/// The mean distance to the nearest neighbour over that of independent places (Clark & Evans 1954, Ecology
/// 35, 445) with Donnelly's correction for edges (1978): below 1 for clusters. NaN for fewer than two stems.
double clark_evans_index(const Stand& stand);

/// Figures of a forest, over several stands of it.
struct StandFigures {
  int stands = 0;
  std::int64_t stems = 0;
  double stems_per_ha = 0;
  double basal_area_m2_per_ha = 0;                        ///< of the stems' cross-sections at 1.3 m
  double median_m = 0, upper_tenth_m = 0, largest_m = 0;  ///< of the diameters
  double clark_evans = 0;                                 ///< mean over stands
  std::vector<double> l_minus_r;                          ///< mean over stands
  std::vector<double> low, high;                          ///< of l_minus_r: 95 % of the stands lie between
};
StandFigures figures_of(const std::vector<Stand>& stands);

/// Whether two forests agree.
struct StandTests {
  double ks_distance = 0;  ///< largest difference of the diameters' distributions
  double ks_p = 1;         ///< Kolmogorov-Smirnov, two samples, asymptotic
  double k_p = 1;          ///< studentised permutation test of both K functions (Hahn 2012, JASA 107, 754)
};
StandTests compare(const std::vector<Stand>& one, const std::vector<Stand>& other);

}  // namespace understory
