#pragma once

#include <string>
#include <vector>

#include "sim/scene/obstacle.hpp"
#include "sim/scene/world.hpp"

namespace understory {

/// MJCF for <asset> and <worldbody>: everything visible. It collides with nothing and is in group_scenery.
struct SceneryXml {
  std::string assets;
  std::string bodies;
};

/// The ground as a textured slab whose upper face is z = 0, and, where they are visible, the obstacles as
/// bark-covered prisms, walls as boxes with windows, one mesh each. The geoms are named "scenery_ground" and
/// "scenery_<number>".
SceneryXml scenery_xml(const std::vector<Obstacle>& obstacles, const WorldConfig& config);

/// Fills those textures that the compiled model has (see models/textures/README.md). Must come before the
/// first renderer of the model.
void paint_textures(mjModel_& model, const WorldConfig& config);

}  // namespace understory
