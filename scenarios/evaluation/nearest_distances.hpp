#pragma once

#include <Eigen/Core>
#include <vector>

namespace understory {

/// From each of `from` the distance to the nearest of `to`, m; +infinity where `to` is empty.
std::vector<double> nearest_distances_m(const std::vector<Eigen::Vector3d>& from,
                                        const std::vector<Eigen::Vector3d>& to);

}  // namespace understory
