#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim/scene/ground_cells.hpp"
#include "sim/scene/woods_mesh.hpp"

namespace understory {

/// A box that may touch leaves: its place at its middle, and half of its size.
struct WingBox {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the frame of what it is compared with
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
};

/// Whether a box and a drawn square of leaves have a point in common, both in one frame.
bool overlaps(const WingBox& box, const LeafCard& card);

/// The drawn leaves of a wood, prepared for a test at every physics step whether the wing touches them.
class LeafContact {
 public:
  /// `boxes`: of the aircraft, in its body frame.
  LeafContact(const std::vector<LeafCard>& cards, std::vector<WingBox> boxes);
  bool touches(const Eigen::Isometry3d& T_world_body) const;

 private:
  std::vector<WingBox> boxes_;
  double reach_m_ = 0;  ///< from the body's origin to the farthest corner of the boxes
  GroundCells<LeafCard> cards_;
};

}  // namespace understory
