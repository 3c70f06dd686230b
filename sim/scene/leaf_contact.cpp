#include "sim/scene/leaf_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace understory {
namespace {

double radius_m(const LeafCard& card) { return std::sqrt(card.x_m.squaredNorm() + card.y_m.squaredNorm()); }

}  // namespace

/// Two convex bodies are apart where a plane parallel to a face of one, or to an edge of each, parts them.
bool overlaps(const WingBox& box, const LeafCard& card) {
  const Eigen::Isometry3d to_box = box.pose.inverse(Eigen::Isometry);
  const Eigen::Vector3d middle = to_box * card.middle_world;
  const Eigen::Vector3d x = to_box.linear() * card.x_m, y = to_box.linear() * card.y_m;
  const auto parts = [&](const Eigen::Vector3d& axis) {
    const double reach = axis.cwiseAbs().dot(box.half_size_m) + std::abs(axis.dot(x)) + std::abs(axis.dot(y));
    return std::abs(axis.dot(middle)) > reach + 1e-12;
  };
  if (parts(x.cross(y))) return false;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i);
    if (parts(axis) || parts(axis.cross(x)) || parts(axis.cross(y))) return false;
  }
  return true;
}

LeafContact::LeafContact(const std::vector<LeafCard>& cards, std::vector<WingBox> boxes)
    : boxes_(std::move(boxes)) {
  for (const WingBox& box : boxes_)
    reach_m_ = std::max(reach_m_, box.pose.translation().norm() + box.half_size_m.norm());
  double cell_m = 1;
  for (const LeafCard& card : cards) cell_m = std::max(cell_m, reach_m_ + radius_m(card));
  cards_ = GroundCells<LeafCard>(cell_m);
  for (const LeafCard& card : cards) cards_.add(card.middle_world, card);
}

bool LeafContact::touches(const Eigen::Isometry3d& T_world_body) const {
  const Eigen::Vector3d& place_world = T_world_body.translation();
  const Eigen::Isometry3d T_body_world = T_world_body.inverse(Eigen::Isometry);
  return cards_.any_around(place_world, [&](const LeafCard& card) {
    const double near_m = reach_m_ + radius_m(card);
    if ((card.middle_world - place_world).squaredNorm() > near_m * near_m) return false;
    const LeafCard in_body{T_body_world * card.middle_world, T_body_world.linear() * card.x_m,
                           T_body_world.linear() * card.y_m};
    return std::ranges::any_of(boxes_, [&](const WingBox& box) { return overlaps(box, in_body); });
  });
}

}  // namespace understory
