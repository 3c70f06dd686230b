#include "sim/render/scene_renderer.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "sim/render/offscreen_context.hpp"
#include "sim/scene/textures.hpp"

namespace understory {
namespace {

/// One sun, no shadows: shaded trunks, evenly lit ground. Lighting per vertex costs almost nothing.
void light(mjvScene& scene) {
  scene.nlight = 1;
  mjvLight& sun = scene.lights[0];
  sun = mjvLight{};
  sun.directional = 1;
  const Eigen::Vector3f shining = Eigen::Vector3f(0.45f, -0.46f, -0.766f).normalized();
  std::copy_n(shining.data(), 3, sun.dir);
  sun.attenuation[0] = 1;
  std::fill_n(sun.ambient, 3, 0.70f);
  std::fill_n(sun.diffuse, 3, 0.30f);
}

/// Sky boxes, shadows, reflections, fog and haze are all off: their cost is large and the detector gains
/// nothing.
void plain_rendering(mjvScene& scene) {
  std::fill(std::begin(scene.flags), std::end(scene.flags), mjtByte{0});
  scene.flags[mjRND_CULL_FACE] = 1;
}

/// MuJoCo draws segid + 1 as red + 256 green + 65536 blue, and nothing, where there is nothing, as black.
cv::Mat object_numbers(const std::uint8_t* pixels, int row_px, const Eye& eye) {
  cv::Mat objects(eye.height_px, eye.width_px, CV_16UC1);
  for (int row = 0; row < objects.rows; ++row) {
    const std::uint8_t* from = pixels + std::size_t{4} * (objects.rows - 1 - row) * row_px;
    auto* to = objects.ptr<std::uint16_t>(row);
    for (int column = 0; column < objects.cols; ++column, from += 4)
      to[column] = static_cast<std::uint16_t>(from[3] == 0 ? object_nothing : from[0] + 256 * from[1]);
  }
  return objects;
}

/// The number of a geom in images of objects, from its name.
int object_of(const std::string& geom_name) {
  constexpr std::string_view prefix = "scenery_";
  if (geom_name == "scenery_ground") return object_ground;
  if (geom_name.rfind(prefix, 0) != 0) return object_nothing;  // a test's own scenery
  return object_first_obstacle + std::stoi(geom_name.substr(prefix.size()));
}

/// A geom's own box, from its mesh; geoms of other types are boxed by their bounding sphere.
GeomBox box_of(const mjModel& model, const mjvGeom& geom) {
  GeomBox box;
  const Eigen::Matrix3d turn =
      Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(geom.mat).cast<double>();
  box.T_world_box.linear() = turn;
  box.T_world_box.translation() = Eigen::Map<const Eigen::Vector3f>(geom.pos).cast<double>();
  const double radius = model.geom_rbound[geom.objid] > 0 ? model.geom_rbound[geom.objid] : 1e6;
  box.half_size.setConstant(radius);
  const int mesh = model.geom_dataid[geom.objid];
  if (geom.type != mjGEOM_MESH || mesh < 0) return box;
  Eigen::AlignedBox3d extent;
  for (int i = 0; i < model.mesh_vertnum[mesh]; ++i)
    extent.extend(Eigen::Map<const Eigen::Vector3f>(model.mesh_vert + 3 * (model.mesh_vertadr[mesh] + i))
                      .cast<double>());
  box.T_world_box = box.T_world_box * Eigen::Translation3d(extent.center());
  box.half_size = 0.5 * extent.sizes();
  return box;
}

/// The same eye for OpenGL: y up and looking along -z. The only place where the axes flip.
mjvGLCamera to_gl(const Eye& eye) {
  mjvGLCamera camera{};
  const Eigen::Matrix3d rotation = eye.T_world_camera.linear();
  for (int i = 0; i < 3; ++i) {
    camera.pos[i] = static_cast<float>(eye.T_world_camera.translation()[i]);
    camera.forward[i] = static_cast<float>(rotation(i, 2));
    camera.up[i] = static_cast<float>(-rotation(i, 1));  // OpenCV's y looks down
  }
  // Edges on the near plane. MuJoCo takes the centre and derives the half width from the viewport's aspect.
  const double metres_per_pixel = near_m / eye.focal_px;
  camera.frustum_center = static_cast<float>((0.5 * (eye.width_px - 1) - eye.center_x_px) * metres_per_pixel);
  camera.frustum_top = static_cast<float>((eye.center_y_px + 0.5) * metres_per_pixel);
  camera.frustum_bottom = static_cast<float>((eye.center_y_px + 0.5 - eye.height_px) * metres_per_pixel);
  camera.frustum_near = static_cast<float>(near_m);
  camera.frustum_far = static_cast<float>(far_m);
  return camera;
}

struct SceneryGeom {
  mjvGeom geom;
  GeomBox box;
  bool obstacle;  ///< not drawn beyond the view distance; the ground is
};

}  // namespace

struct SceneRenderer::Scene {
  OffscreenContext gl;
  mjrContext context{};
  mjvScene shown{};
  std::vector<SceneryGeom> scenery;
  std::unique_ptr<WoodsPass> woods;
  unsigned mujocos_framebuffer = 0;  ///< the one that MuJoCo made, where it draws into ours
  std::string stale_errors;
  std::thread::id thread = std::this_thread::get_id();

  explicit Scene(RendererKind renderer) : gl(renderer) {
    mjr_defaultContext(&context);
    mjv_defaultScene(&shown);
  }
  ~Scene() {
    gl.make_current(64, 64);  // both delete their GL objects in the current context
    woods.reset();
    mjv_freeScene(&shown);
    if (mujocos_framebuffer != 0) context.offFBO = mujocos_framebuffer;
    mjr_freeContext(&context);
  }

  /// Scenes whose renderers ended on another thread. A context that is current on two threads ends a process.
  static inline auto& waiting = *new std::vector<std::unique_ptr<Scene>>;  // a thread may end after main()
  static inline auto& waiting_mutex = *new std::mutex;
};

SceneRenderer::SceneRenderer(const mjModel& model, double view_distance_m, int width_px, int height_px,
                             RendererKind renderer, std::shared_ptr<const WoodsMesh> woods)
    : model_(model), view_distance_m_(view_distance_m) {
  {
    const std::lock_guard lock(Scene::waiting_mutex);
    std::erase_if(Scene::waiting, [](const auto& one) { return one->thread == std::this_thread::get_id(); });
  }
  scene_ = std::make_unique<Scene>(renderer);
  begin_picture(width_px, height_px);
  make_context();
  begin_picture(width_px, height_px);
  mjr_setBuffer(scene_->gl.framebuffer() != 0 ? mjFB_OFFSCREEN : mjFB_WINDOW, &scene_->context);
  mjv_makeScene(&model_, &scene_->shown, model_.ngeom + 100);
  plain_rendering(scene_->shown);
  gather_scenery();
  if (woods != nullptr) scene_->woods = std::make_unique<WoodsPass>(std::move(woods), scene_->gl);
}

SceneRenderer::~SceneRenderer() {
  if (scene_->thread == std::this_thread::get_id()) return;
  const std::lock_guard lock(Scene::waiting_mutex);
  Scene::waiting.push_back(std::move(scene_));
}

std::string SceneRenderer::name() const {
  return scene_->gl.renderer() + (scene_->stale_errors.empty() ? "" : ", began with " + scene_->stale_errors);
}

/// Another renderer may have drawn since.
void SceneRenderer::begin_picture(int width_px, int height_px) {
  scene_->gl.make_current(width_px, height_px);
  if (scene_->mujocos_framebuffer != 0) scene_->context.offFBO = scene_->gl.framebuffer();
}

/// MuJoCo would let OpenGL compute the textures' mipmaps, which takes most of its start. So MuJoCo gets
/// textures of one pixel to set up, and they are filled here.
void SceneRenderer::make_context() {
  const auto filled_here = [&](int texture) {
    return model_.tex_type[texture] == mjTEXTURE_2D &&
           std::has_single_bit(static_cast<unsigned>(model_.tex_width[texture])) &&
           std::has_single_bit(static_cast<unsigned>(model_.tex_height[texture]));
  };
  std::vector<int> widths_px(model_.tex_width, model_.tex_width + model_.ntex);
  std::vector<int> heights_px(model_.tex_height, model_.tex_height + model_.ntex);
  for (int i = 0; i < model_.ntex; ++i)
    if (filled_here(i)) widths_px[i] = heights_px[i] = 1;
  mjModel shown = model_;
  shown.tex_width = widths_px.data();
  shown.tex_height = heights_px.data();
  scene_->stale_errors = scene_->gl.take_errors();  // MuJoCo would take them for its own
  try {
    mjr_makeContext(&shown, &scene_->context, mjFONTSCALE_100);
  } catch (const SimulationError& error) {
    throw std::runtime_error(std::string(error.what()) + " (drawn by " + scene_->gl.renderer() + ")");
  }
  if (scene_->gl.framebuffer() != 0) scene_->mujocos_framebuffer = scene_->context.offFBO;
  for (int i = 0; i < model_.ntex; ++i) {
    const unsigned texture = scene_->context.texture[i];
    if (filled_here(i)) {
      const int width_px = model_.tex_width[i], height_px = model_.tex_height[i];
      const std::uint8_t* rgb = model_.tex_rgb + model_.tex_adr[i];
      scene_->gl.upload_level(texture, 0, width_px, height_px, rgb);
      int level = 0;
      for (const TextureLevel& copy : smaller_copies(width_px, height_px, rgb))
        scene_->gl.upload_level(texture, ++level, copy.width_px, copy.height_px, copy.rgb.data());
    }
    if (scene_->context.textureType[i] == mjTEXTURE_2D) scene_->gl.use_nearest_mipmap(texture);
  }
}

/// Scenery stands still: its geoms are made once.
void SceneRenderer::gather_scenery() {
  const DataPointer data(mj_makeData(&model_));
  mj_kinematics(&model_, data.get());
  update_scene(*data, false);
  for (int i = 0; i < scene_->shown.ngeom; ++i) {
    mjvGeom geom = scene_->shown.geoms[i];
    const char* name = mj_id2name(&model_, mjOBJ_GEOM, geom.objid);
    const int object = object_of(name != nullptr ? name : "");
    geom.segid = object - 1;
    scene_->scenery.push_back({geom, box_of(model_, geom), object != object_ground});
  }
}

void SceneRenderer::update_scene(const mjData& data, bool with_aircraft) {
  mjvOption option;
  mjv_defaultOption(&option);
  std::fill(std::begin(option.geomgroup), std::end(option.geomgroup), mjtByte{0});
  std::fill(std::begin(option.sitegroup), std::end(option.sitegroup), mjtByte{0});
  option.geomgroup[group_scenery] = 1;
  option.geomgroup[group_aircraft_skin] = with_aircraft;
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  // mjv_updateScene takes mutable data and writes none of it.
  mjv_updateScene(&model_, const_cast<mjData*>(&data), &option, nullptr, &camera,
                  mjCAT_STATIC | mjCAT_DYNAMIC, &scene_->shown);
  light(scene_->shown);
}

/// Nearest first, so that hidden pixels are not shaded. Geoms that no camera sees are not given to MuJoCo.
void SceneRenderer::fill_scene(const std::array<Eye, 2>& eyes) {
  std::vector<std::pair<double, const SceneryGeom*>> seen;
  for (const SceneryGeom& item : scene_->scenery) {
    const double range_m = distance_m(eyes[0].T_world_camera.translation(), item.box);
    if (culls_ && item.obstacle && range_m > view_distance_m_) continue;
    if (!culls_ || may_see(eyes[0], item.box) || may_see(eyes[1], item.box))
      seen.emplace_back(item.obstacle ? range_m : far_m, &item);
  }
  std::stable_sort(seen.begin(), seen.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  scene_->shown.ngeom = 0;
  for (const auto& [range_m, item] : seen) scene_->shown.geoms[scene_->shown.ngeom++] = item->geom;
  scene_->shown.camera[0] = to_gl(eyes[0]);
  scene_->shown.camera[1] = to_gl(eyes[1]);
  light(scene_->shown);
}

const std::uint8_t* SceneRenderer::render(const std::array<Eye, 2>& eyes, WoodsDrawing drawing) {
  begin_picture(2 * eyes[0].width_px, eyes[0].height_px);
  if (scene_->woods != nullptr) {
    scene_->woods->draw(eyes, 2, drawing, {}, true);
    return scene_->gl.finished_pixels();
  }
  fill_scene(eyes);
  scene_->shown.stereo = mjSTEREO_SIDEBYSIDE;
  mjr_render({0, 0, 2 * eyes[0].width_px, eyes[0].height_px}, &scene_->shown, &scene_->context);
  return scene_->gl.finished_pixels();
}

std::array<cv::Mat, 2> SceneRenderer::gray_pair(const std::array<Eye, 2>& eyes) {
  const std::uint8_t* pixels = render(eyes);
  const int width_px = eyes[0].width_px;
  return {gray_with_sky(pixels, 2 * width_px, eyes[0]),
          gray_with_sky(pixels + 4 * width_px, 2 * width_px, eyes[1])};
}

cv::Mat SceneRenderer::left_depth(const std::array<Eye, 2>& eyes) {
  render(eyes, WoodsDrawing::numbers);
  return read_depth(eyes[0]);
}

TrueView SceneRenderer::true_left_view(const std::array<Eye, 2>& eyes) {
  scene_->shown.flags[mjRND_SEGMENT] = scene_->shown.flags[mjRND_IDCOLOR] =
      1;  // flat: a geom's number for its colour
  const std::uint8_t* pixels = render(eyes, WoodsDrawing::numbers);
  scene_->shown.flags[mjRND_SEGMENT] = scene_->shown.flags[mjRND_IDCOLOR] = 0;
  return {read_depth(eyes[0]), object_numbers(pixels, 2 * eyes[0].width_px, eyes[0]),
          read_depth(eyes[1], eyes[0].width_px)};
}

cv::Mat SceneRenderer::read_depth(const Eye& eye, int from_px) {
  cv::Mat depth(eye.height_px, eye.width_px, CV_32FC1);
  std::vector<float> values(depth.total());
  mjr_readPixels(nullptr, values.data(), {from_px, 0, depth.cols, depth.rows}, &scene_->context);
  for (int row = 0; row < depth.rows; ++row) {
    const float* source = values.data() + static_cast<std::size_t>(depth.rows - 1 - row) * depth.cols;
    std::transform(source, source + depth.cols, depth.ptr<float>(row),
                   [](float value) { return static_cast<float>(depth_of_gl(value)); });
  }
  return depth;
}

cv::Mat SceneRenderer::colour_with_aircraft(const mjData& data, const Eye& eye) {
  update_scene(data, true);
  scene_->shown.camera[0] = scene_->shown.camera[1] = to_gl(eye);
  scene_->shown.stereo = mjSTEREO_NONE;
  begin_picture(eye.width_px, eye.height_px);
  mjr_render({0, 0, eye.width_px, eye.height_px}, &scene_->shown, &scene_->context);
  if (scene_->woods != nullptr)
    scene_->woods->draw({eye, eye}, 1, WoodsDrawing::colour, {.near_m = 60}, false);
  return colour_with_sky(scene_->gl.finished_pixels(), eye);
}

}  // namespace understory
