#pragma once

#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "sim/render/eye.hpp"
#include "sim/render/renderer_kind.hpp"
#include "sim/render/woods_pass.hpp"
#include "sim/scene/world.hpp"

namespace understory {

/// Draws the model's scenery through pinhole eyes, offscreen. Not thread safe; create and use on one thread.
/// If it is destroyed on another thread, its OpenGL context is kept until its own thread makes a renderer.
class SceneRenderer {
 public:
  /// Keeps a reference to the model. The size is that of the first picture; others may follow. Throws
  /// std::runtime_error in one line where no GL library can be loaded. With `woods` the scenery is the woods,
  /// and only the aircraft is drawn from the model.
  SceneRenderer(const mjModel_& model, double view_distance_m, int width_px, int height_px,
                RendererKind renderer, std::shared_ptr<const WoodsMesh> woods = nullptr);
  ~SceneRenderer();
  SceneRenderer(const SceneRenderer&) = delete;
  SceneRenderer& operator=(const SceneRenderer&) = delete;

  /// Both eyes' views, CV_8UC1; the eyes must be of one size.
  std::array<cv::Mat, 2> gray_pair(const std::array<Eye, 2>& eyes);
  /// Depth in the left eye's view: CV_32FC1, metres along the optical axis.
  cv::Mat left_depth(const std::array<Eye, 2>& eyes);
  /// The same depth and the objects, from one drawing.
  TrueView true_left_view(const std::array<Eye, 2>& eyes);
  /// One eye's view of everything, the aircraft's skin too: BGR, 8 bits, for people.
  cv::Mat colour_with_aircraft(const mjData_& data, const Eye& eye);
  /// For comparison: from now on all scenery is drawn, however far away and wherever it is.
  void stop_culling() { culls_ = false; }
  /// The renderer's own name and version.
  std::string name() const;

 private:
  struct Scene;  ///< MuJoCo's own structures and the OpenGL context that they belong to
  void begin_picture(int width_px, int height_px);
  void make_context();
  void gather_scenery();
  void update_scene(const mjData_& data, bool with_aircraft);
  void fill_scene(const std::array<Eye, 2>& eyes);
  /// RGBA of both eyes side by side, as OffscreenContext::finished_pixels.
  const std::uint8_t* render(const std::array<Eye, 2>& eyes, WoodsDrawing drawing = WoodsDrawing::gray);
  /// Of the eye whose picture begins at this column, as last rendered.
  cv::Mat read_depth(const Eye& eye, int from_px = 0);

  const mjModel_& model_;
  double view_distance_m_;
  bool culls_ = true;
  std::unique_ptr<Scene> scene_;
};

}  // namespace understory
