#include "perception/pushbroom/isolation.hpp"

#include <cstddef>

namespace understory {
namespace {

/// Looks outwards from the hit in the frame's order: neighbours in the image are near in the order too, so
/// hits with company are settled after a few steps, and hits without are few, since they keep their distance.
bool has_company(const std::vector<StereoHit>& hits, std::size_t index, int minimum_points, double radius_m) {
  const Eigen::Vector3d& here = hits[index].position_camera;
  int found = 1;
  const auto count = [&](std::size_t other) {
    if ((hits[other].position_camera - here).squaredNorm() <= radius_m * radius_m) ++found;
  };
  for (std::size_t step = 1; found < minimum_points && (step <= index || index + step < hits.size());
       ++step) {
    if (index + step < hits.size()) count(index + step);
    if (step <= index) count(index - step);
  }
  return found >= minimum_points;
}

}  // namespace

void without_isolated(const std::vector<StereoHit>& hits, int minimum_points, double radius_m,
                      std::vector<StereoHit>& kept) {
  kept.clear();
  for (std::size_t index = 0; index < hits.size(); ++index)
    if (has_company(hits, index, minimum_points, radius_m)) kept.push_back(hits[index]);
}

}  // namespace understory
