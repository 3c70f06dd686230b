#include "planning/column_bounds.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planning/column_bounds.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which decides what highway.h means.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace understory {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, widest_vector>;

float BoundClearances(const ColumnArrays& columns, std::size_t first, std::size_t count,
                      const Eigen::Vector3f& middle, const Eigen::Vector3f& half_wing, float* bounds_m) {
  const Floats d;
  const auto x = hn::Set(d, middle.x()), y = hn::Set(d, middle.y());
  const auto across_x = hn::Set(d, half_wing.x()), across_y = hn::Set(d, half_wing.y());
  const auto low = hn::Set(d, middle.z() - std::abs(half_wing.z())),
             high = hn::Set(d, middle.z() + std::abs(half_wing.z()));
  const auto per_across_m2 = hn::Set(d, 1 / std::max(half_wing.head<2>().squaredNorm(), 1e-12f));
  auto least = hn::Set(d, INFINITY);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const std::size_t at = first + i;
    const auto beside_x = hn::Sub(hn::LoadU(d, columns.x_m.data() + at), x),
               beside_y = hn::Sub(hn::LoadU(d, columns.y_m.data() + at), y);
    const auto share = hn::Mul(hn::MulAdd(beside_x, across_x, hn::Mul(beside_y, across_y)), per_across_m2);
    const auto along = hn::Min(hn::Max(share, hn::Set(d, -1.0f)), hn::Set(d, 1.0f));
    const auto off_x = hn::NegMulAdd(along, across_x, beside_x),
               off_y = hn::NegMulAdd(along, across_y, beside_y);
    const auto gap = hn::Max(hn::Max(hn::Sub(hn::LoadU(d, columns.bottom_m.data() + at), high),
                                     hn::Sub(low, hn::LoadU(d, columns.top_m.data() + at))),
                             hn::Zero(d));
    const auto squared = hn::MulAdd(off_x, off_x, hn::MulAdd(off_y, off_y, hn::Mul(gap, gap)));
    const auto bound = hn::Sub(hn::Sqrt(squared), hn::LoadU(d, columns.around_m.data() + at));
    hn::StoreU(bound, d, bounds_m + i);
    least = hn::Min(least, hn::IfThenElse(hn::FirstN(d, count - i), bound, least));
  }
  return hn::GetLane(hn::MinOfLanes(d, least));
}

std::size_t NextWithin(const float* bounds_m, std::size_t from, std::size_t count, float most_m) {
  const Floats d;
  for (std::size_t i = from; i < count; i += hn::Lanes(d)) {
    const auto found = hn::FindFirstTrue(d, hn::Le(hn::LoadU(d, bounds_m + i), hn::Set(d, most_m)));
    if (found >= 0) return std::min(i + static_cast<std::size_t>(found), count);
  }
  return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace understory
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace understory {

HWY_EXPORT(BoundClearances);
HWY_EXPORT(NextWithin);

void ColumnArrays::resize(std::size_t count) {
  for (std::vector<float>* numbers : {&x_m, &y_m, &bottom_m, &top_m, &around_m})
    numbers->resize(count + widest_vector);
}

float bound_clearances(const ColumnArrays& columns, std::size_t first, std::size_t count,
                       const Eigen::Vector3f& middle, const Eigen::Vector3f& half_wing,
                       std::vector<float>& bounds_m) {
  if (bounds_m.size() < count + widest_vector) bounds_m.resize(count + widest_vector);
  return HWY_DYNAMIC_DISPATCH(BoundClearances)(columns, first, count, middle, half_wing, bounds_m.data());
}

std::size_t next_within(const std::vector<float>& bounds_m, std::size_t from, std::size_t count,
                        float most_m) {
  return HWY_DYNAMIC_DISPATCH(NextWithin)(bounds_m.data(), from, count, most_m);
}

}  // namespace understory
#endif
