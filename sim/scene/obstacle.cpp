#include "sim/scene/obstacle.hpp"

namespace understory {

// Not in the header: Eigen's product of translation and turn is a tenth of a small file's compilation.
Eigen::Isometry3d Obstacle::T_world_box() const {
  return Eigen::Translation3d(0.5 * (from_world + to_world)) * turn_world;
}

}  // namespace understory
