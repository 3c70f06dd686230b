#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace understory {

/// How many floats the widest vector of any processor holds. Arrays are read up to so many beyond their end.
inline constexpr std::size_t widest_vector = 16;

/// Columns of the obstacle field as arrays, so that a processor bounds many distances at once. Places are
/// counted from the field's origin, m. The vectors may be read beyond what was asked for; `resize` leaves
/// room.
struct ColumnArrays {
  std::vector<float> x_m, y_m, bottom_m, top_m;
  std::vector<float> around_m;  ///< radius of the column, and of the wing

  void resize(std::size_t count);
};

/// Lower bounds of the clearances between a wing and `count` columns from `first` on: no column is nearer
/// than its axis to the wing's projection, seen from above, nor, seen from the side, than the gap between its
/// heights and the wing's. `half_wing`: from `middle` (from the field's origin) to a tip. Returns the least
/// bound.
float bound_clearances(const ColumnArrays& columns, std::size_t first, std::size_t count,
                       const Eigen::Vector3f& middle, const Eigen::Vector3f& half_wing,
                       std::vector<float>& bounds_m);

/// The place of the first of the first `count` bounds, from `from` on, that is at most `most_m`; else
/// `count`.
std::size_t next_within(const std::vector<float>& bounds_m, std::size_t from, std::size_t count,
                        float most_m);

}  // namespace understory
