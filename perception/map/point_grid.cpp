#include "perception/map/point_grid.hpp"

namespace understory {

void PointGrid::clear() {
  heads_.assign(heads_.empty() ? 1024 : heads_.size(), -1);
  next_.clear();
  cells_.clear();
}

std::size_t PointGrid::bucket_of(const Cell& cell) const {
  // Three large odd primes (Teschner et al. 2003, spatial hashing); unsigned arithmetic wraps, which is
  // meant.
  const auto mixed = static_cast<std::uint64_t>(cell[0]) * 73856093u ^
                     static_cast<std::uint64_t>(cell[1]) * 19349663u ^
                     static_cast<std::uint64_t>(cell[2]) * 83492791u;
  return static_cast<std::size_t>(mixed ^ (mixed >> 17)) & (heads_.size() - 1);
}

void PointGrid::add(const Eigen::Vector3d& position) {
  cells_.push_back(cell_of(position));
  next_.push_back(-1);
  if (cells_.size() > heads_.size()) {
    grow();
    return;
  }
  int& head = heads_[bucket_of(cells_.back())];
  next_.back() = head;
  head = static_cast<int>(cells_.size()) - 1;
}

void PointGrid::grow() {
  heads_.assign(heads_.size() * 2, -1);
  for (std::size_t index = 0; index < cells_.size(); ++index) {
    int& head = heads_[bucket_of(cells_[index])];
    next_[index] = head;
    head = static_cast<int>(index);
  }
}

int PointGrid::find_in_cell(const Eigen::Vector3d& position) const {
  const Cell cell = cell_of(position);
  for (int index = heads_[bucket_of(cell)]; index >= 0; index = next_[static_cast<std::size_t>(index)])
    if (same(cells_[static_cast<std::size_t>(index)], cell)) return index;
  return -1;
}

}  // namespace understory
