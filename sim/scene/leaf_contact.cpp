#include "sim/scene/leaf_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace understory {
namespace {

double radius_m(const LeafCard& card) { return std::sqrt(card.x_m.squaredNorm() + card.y_m.squaredNorm()); }

std::pair<int, int> cell_of(const Eigen::Vector3d& place_world, double cell_m) {
  return {static_cast<int>(std::floor(place_world.x() / cell_m)),
          static_cast<int>(std::floor(place_world.y() / cell_m))};
}

}  // namespace

/// Two convex bodies are apart where a plane parallel to a face of one, or to an edge of each, parts them.
bool overlaps(const WingBox& box, const LeafCard& card) {
  const Eigen::Isometry3d T_box_world = box.T_world_box.inverse(Eigen::Isometry);
  const Eigen::Vector3d middle = T_box_world * card.middle_world;
  const Eigen::Vector3d x = T_box_world.linear() * card.x_m, y = T_box_world.linear() * card.y_m;
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

LeafContact::LeafContact(const std::vector<LeafCard>& cards, double reach_m) : cell_m_(1), reach_m_(reach_m) {
  for (const LeafCard& card : cards) cell_m_ = std::max(cell_m_, reach_m + radius_m(card));
  for (const LeafCard& card : cards) cells_[cell_of(card.middle_world, cell_m_)].push_back(card);
}

bool LeafContact::touches(const Eigen::Vector3d& place_world, const std::vector<WingBox>& boxes) const {
  const auto [column, row] = cell_of(place_world, cell_m_);
  for (int x = column - 1; x <= column + 1; ++x)
    for (int y = row - 1; y <= row + 1; ++y) {
      const auto cell = cells_.find({x, y});
      if (cell == cells_.end()) continue;
      for (const LeafCard& card : cell->second) {
        const double near_m = reach_m_ + radius_m(card);
        if ((card.middle_world - place_world).squaredNorm() > near_m * near_m) continue;
        if (std::ranges::any_of(boxes, [&](const WingBox& box) { return overlaps(box, card); })) return true;
      }
    }
  return false;
}

}  // namespace understory
