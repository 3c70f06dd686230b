#include "scenarios/evaluation/nearest_distances.hpp"

#include <cmath>
#include <limits>
#include <nanoflann.hpp>

namespace understory {
namespace {

/// What nanoflann asks of a cloud of points.
struct Cloud {
  const std::vector<Eigen::Vector3d>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points[index][static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3>;

}  // namespace

std::vector<double> nearest_distances_m(const std::vector<Eigen::Vector3d>& from,
                                        const std::vector<Eigen::Vector3d>& to) {
  std::vector<double> distances_m(from.size(), std::numeric_limits<double>::infinity());
  if (to.empty() || from.empty()) return distances_m;
  const Cloud cloud{to};
  Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  tree.buildIndex();
  for (std::size_t i = 0; i < from.size(); ++i) {
    unsigned int index = 0;
    double squared_m2 = 0;
    tree.knnSearch(from[i].data(), 1, &index, &squared_m2);
    distances_m[i] = std::sqrt(squared_m2);
  }
  return distances_m;
}

}  // namespace understory
