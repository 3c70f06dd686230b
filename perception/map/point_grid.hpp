#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace understory {

/// Points hashed by the cubic cell they lie in, numbered 0, 1, 2 ... as they are added. Cheap to fill and to
/// throw away, which for a map that changes at every frame beats a search tree. Chains are walked in a fixed
/// order.
class PointGrid {
 public:
  explicit PointGrid(double cell_m) : cell_m_(cell_m) { clear(); }

  void clear();
  void add(const Eigen::Vector3d& position);
  /// The last point added to the cell that `position` lies in, or -1.
  int find_in_cell(const Eigen::Vector3d& position) const;

  /// Calls visit(index) for every point in the cell of `position` and the 26 around it, among which are all
  /// points within one cell size; stops as soon as visit returns false.
  template <typename Visit>
  void visit_near(const Eigen::Vector3d& position, Visit&& visit) const {
    const Cell center = cell_of(position);
    if (!visit_cell(center, visit)) return;  // first, since the nearest points are likeliest here
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz)
          if ((dx || dy || dz) && !visit_cell({center[0] + dx, center[1] + dy, center[2] + dz}, visit))
            return;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cell_of(const Eigen::Vector3d& position) const {
    return {static_cast<std::int64_t>(std::floor(position.x() / cell_m_)),
            static_cast<std::int64_t>(std::floor(position.y() / cell_m_)),
            static_cast<std::int64_t>(std::floor(position.z() / cell_m_))};
  }
  std::size_t bucket_of(const Cell& cell) const;
  /// std::array's == calls memcmp, which here costs more than everything around it.
  static bool same(const Cell& a, const Cell& b) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }

  template <typename Visit>
  bool visit_cell(const Cell& cell, Visit& visit) const {
    for (int index = heads_[bucket_of(cell)]; index >= 0; index = next_[static_cast<std::size_t>(index)])
      if (same(cells_[static_cast<std::size_t>(index)], cell) && !visit(index)) return false;
    return true;
  }
  void grow();

  double cell_m_;
  std::vector<int> heads_;  // newest point of each bucket, -1 where empty; a power of two of them
  std::vector<int> next_;   // the point added to the same bucket before
  std::vector<Cell> cells_;
};

}  // namespace understory
