#pragma once

#include <Eigen/Geometry>
#include <map>
#include <utility>
#include <vector>

#include "sim/scene/woods_mesh.hpp"

namespace understory {

/// A box that may touch leaves: its place in the world (at its middle) and half of its size.
struct WingBox {
  Eigen::Isometry3d T_world_box = Eigen::Isometry3d::Identity();
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
};

/// Whether a box and a drawn square of leaves have a point in common.
bool overlaps(const WingBox& box, const LeafCard& card);

/// The drawn leaves of a wood, ready to be asked at every physics step what touches them.
class LeafContact {
 public:
  /// `reach_m`: from the place that touches() is asked about to the farthest corner of any of its boxes.
  LeafContact(const std::vector<LeafCard>& cards, double reach_m);
  bool touches(const Eigen::Vector3d& place_world, const std::vector<WingBox>& boxes) const;

 private:
  double cell_m_, reach_m_;
  std::map<std::pair<int, int>, std::vector<LeafCard>> cells_;
};

}  // namespace understory
