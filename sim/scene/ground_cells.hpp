#pragma once

#include <Eigen/Core>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace understory {

/// Things sorted into square cells of the ground by their place. If cells are as wide as the reach of any
/// thing, all things within reach of a place are in its cell and in the eight around it.
template <typename Thing>
class GroundCells {
 public:
  explicit GroundCells(double cell_m = 1) : cell_m_(cell_m) {}

  void add(const Eigen::Vector3d& place_world, const Thing& thing) {
    cells_[cell_of(place_world)].push_back(thing);
  }
  /// Calls visit(thing) cell by cell, in the order in which things were added, until it returns true.
  template <typename Visit>
  bool any_around(const Eigen::Vector3d& place_world, Visit&& visit) const {
    const auto [column, row] = cell_of(place_world);
    for (int x = column - 1; x <= column + 1; ++x)
      for (int y = row - 1; y <= row + 1; ++y)
        if (const auto cell = cells_.find({x, y}); cell != cells_.end())
          for (const Thing& thing : cell->second)
            if (visit(thing)) return true;
    return false;
  }

 private:
  std::pair<int, int> cell_of(const Eigen::Vector3d& place_world) const {
    return {static_cast<int>(std::floor(place_world.x() / cell_m_)),
            static_cast<int>(std::floor(place_world.y() / cell_m_))};
  }

  double cell_m_;
  std::map<std::pair<int, int>, std::vector<Thing>> cells_;
};

}  // namespace understory
