#pragma once

#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "sim/render/eye.hpp"
#include "sim/scene/woods_mesh.hpp"

namespace understory {

class OffscreenContext;

/// What is drawn of a wood: gray is what cameras see, in all three channels; numbers give each pixel the
/// number of its object, and are drawn with every side of every tube, as true depth is.
enum class WoodsDrawing { gray, colour, numbers };
/// How far detail is drawn: cameras draw the cheaper design beyond `near_m`.
struct WoodsDetail {
  double near_m = 11;
  double fine_m = 4;    ///< gray alone: tubes have half of their sides beyond
  double smooth_m = 6;  ///< gray alone: textures take the nearest texel beyond
  double reach_m = 80;  ///< nothing is drawn beyond
};

/// Draws a wood with OpenGL in the context that is current, beside what MuJoCo draws. Keeps in the context's
/// memory the pieces of the mesh that are near. Needs OpenGL 2.0; restores the state that MuJoCo relies on.
class WoodsPass {
 public:
  /// Throws std::runtime_error in one line where the context cannot compile the shaders.
  WoodsPass(std::shared_ptr<const WoodsMesh> mesh, const OffscreenContext& context);
  ~WoodsPass();
  WoodsPass(const WoodsPass&) = delete;
  WoodsPass& operator=(const WoodsPass&) = delete;

  /// The first `count` eyes side by side into the current picture. What is drawn is chosen once for both, so
  /// that leaves far away are the same for both. `clears` empties the picture first.
  void draw(const std::array<Eye, 2>& eyes, std::size_t count, WoodsDrawing drawing,
            const WoodsDetail& detail, bool clears);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace understory
