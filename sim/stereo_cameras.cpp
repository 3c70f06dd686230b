#include "sim/stereo_cameras.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "sim/camera_frustum.hpp"
#include "sim/image_sensor.hpp"
#include "sim/offscreen_context.hpp"

namespace understory {
namespace {

/// One sun, no shadows: shaded trunks, evenly lit ground. Lighting is computed per vertex and costs next to
/// nothing.
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

struct SceneryGeom {
  mjvGeom geom;
  GeomBox box;
  bool obstacle;  ///< not drawn beyond the view distance; the ground is
};

Eigen::Isometry3d aircraft_pose(const mjModel& model, const mjData& data) {
  const int joint = mj_name2id(&model, mjOBJ_JOINT, "aircraft_free");
  if (joint < 0) throw std::runtime_error("the model has no joint \"aircraft_free\" to carry the cameras");
  const mjtNum* q = data.qpos + model.jnt_qposadr[joint];  // newer than data.xpos, which lags one step
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(q[0], q[1], q[2]);
  pose.linear() = Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized().toRotationMatrix();
  return pose;
}

}  // namespace

struct StereoCameras::Implementation {
  const mjModel& model;
  StereoRig rig;
  CameraConfig config;
  OffscreenContext gl;
  mjrContext renderer{};
  mjvScene scene{};
  std::vector<SceneryGeom> scenery;
  ImageNoise noise;

  Implementation(const mjModel& model_, const StereoRig& rig_, const CameraConfig& config_,
                 std::uint64_t seed)
      : model(model_), rig(rig_), config(config_), noise(config_.noise_gray, seed) {
    gl.make_current(2 * rig.width_px, rig.height_px);
    mjr_defaultContext(&renderer);
    mjr_makeContext(&model, &renderer, mjFONTSCALE_100);
    mjr_setBuffer(mjFB_WINDOW, &renderer);
    for (int i = 0; i < renderer.ntexture; ++i)
      if (renderer.textureType[i] == mjTEXTURE_2D) gl.use_nearest_mipmap(renderer.texture[i]);
    mjv_defaultScene(&scene);
    mjv_makeScene(&model, &scene, model.ngeom + 100);
    plain_rendering(scene);
    gather_scenery();
  }

  ~Implementation() {
    gl.make_current(2 * rig.width_px, rig.height_px);  // MuJoCo deletes its GL objects in the current context
    mjv_freeScene(&scene);
    mjr_freeContext(&renderer);
  }

  /// Scenery stands still: its geoms are made once.
  void gather_scenery() {
    const DataPointer data(mj_makeData(&model));
    mj_kinematics(&model, data.get());
    update_scene(*data, false);
    for (int i = 0; i < scene.ngeom; ++i) {
      const mjvGeom& geom = scene.geoms[i];
      const char* name = mj_id2name(&model, mjOBJ_GEOM, geom.objid);
      const bool ground = name != nullptr && std::string(name) == "scenery_ground";
      scenery.push_back({geom, box_of(model, geom), !ground});
    }
  }

  void update_scene(const mjData& data, bool with_aircraft) {
    mjvOption option;
    mjv_defaultOption(&option);
    std::fill(std::begin(option.geomgroup), std::end(option.geomgroup), mjtByte{0});
    std::fill(std::begin(option.sitegroup), std::end(option.sitegroup), mjtByte{0});
    option.geomgroup[group_scenery] = 1;
    option.geomgroup[group_aircraft_skin] = with_aircraft;
    mjvCamera camera;
    mjv_defaultCamera(&camera);
    // mjv_updateScene takes mutable data and writes none of it.
    mjv_updateScene(&model, const_cast<mjData*>(&data), &option, nullptr, &camera,
                    mjCAT_STATIC | mjCAT_DYNAMIC, &scene);
    light(scene);
  }

  /// Nearest first, so that what is hidden is not shaded; what no eye sees is not given to MuJoCo at all.
  void fill_scene(const std::array<Eye, 2>& eyes) {
    std::vector<std::pair<double, const SceneryGeom*>> seen;
    for (const SceneryGeom& item : scenery) {
      const double range_m = distance_m(eyes[0].T_world_camera.translation(), item.box);
      if (item.obstacle && range_m > config.view_distance_m) continue;
      if (may_see(eyes[0], item.box) || may_see(eyes[1], item.box))
        seen.emplace_back(item.obstacle ? range_m : far_m, &item);
    }
    std::stable_sort(seen.begin(), seen.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    scene.ngeom = 0;
    for (const auto& [range_m, item] : seen) scene.geoms[scene.ngeom++] = item->geom;
    scene.camera[0] = to_gl(eyes[0]);
    scene.camera[1] = to_gl(eyes[1]);
    light(scene);
  }

  std::array<Eye, 2> render_pair(const mjData& data) {
    gl.make_current(2 * rig.width_px, rig.height_px);  // another pair of cameras may have drawn since
    const std::array<Eye, 2> eyes = eyes_of(rig, aircraft_pose(model, data));
    fill_scene(eyes);
    scene.stereo = mjSTEREO_SIDEBYSIDE;
    mjr_render({0, 0, 2 * rig.width_px, rig.height_px}, &scene, &renderer);
    gl.finish();
    return eyes;
  }
};

StereoCameras::StereoCameras(const World& world, const StereoRig& rig, const CameraConfig& config,
                             std::uint64_t noise_seed)
    : implementation_(std::make_unique<Implementation>(*world.model, rig, config, noise_seed)) {}

StereoCameras::~StereoCameras() = default;

StereoFrame StereoCameras::capture(const mjData& data, std::int64_t t_ns) {
  Implementation& self = *implementation_;
  const cv::Size size(self.rig.width_px, self.rig.height_px);
  StereoFrame frame{t_ns, {}, {}};
  if (self.config.lens_cap) {
    frame.left = cv::Mat::zeros(size, CV_8UC1);
    frame.right = cv::Mat::zeros(size, CV_8UC1);
  } else {
    const auto eyes = self.render_pair(data);
    frame.left = gray_with_sky(self.gl.pixels(), 2 * size.width, eyes[0]);
    frame.right = gray_with_sky(self.gl.pixels() + 4 * size.width, 2 * size.width, eyes[1]);
  }
  self.noise.add_to(frame.left);
  self.noise.add_to(frame.right);
  return frame;
}

cv::Mat StereoCameras::depth(const mjData& data) {
  Implementation& self = *implementation_;
  self.render_pair(data);
  cv::Mat depth(self.rig.height_px, self.rig.width_px, CV_32FC1);
  std::vector<float> values(depth.total());
  mjr_readPixels(nullptr, values.data(), {0, 0, depth.cols, depth.rows}, &self.renderer);
  for (int row = 0; row < depth.rows; ++row) {
    const float* source = values.data() + static_cast<std::size_t>(depth.rows - 1 - row) * depth.cols;
    std::transform(source, source + depth.cols, depth.ptr<float>(row),
                   [](float value) { return static_cast<float>(depth_of_gl(value)); });
  }
  return depth;
}

cv::Mat StereoCameras::chase_view(const mjData& data, int width_px, int height_px) {
  Implementation& self = *implementation_;
  const Eigen::Isometry3d aircraft = aircraft_pose(self.model, data);
  const Eigen::Vector3d forward = aircraft.linear().col(0);
  const double yaw_rad = std::atan2(forward.y(), forward.x());
  constexpr double behind_m = 3.2, above_m = 1.1, down_rad = 0.20;
  Eye eye{Eigen::Isometry3d::Identity(), 0.8 * width_px, 0.5 * (width_px - 1),
          0.5 * (height_px - 1),         width_px,       height_px};
  const Eigen::Vector3d ahead(std::cos(yaw_rad), std::sin(yaw_rad), 0);
  eye.T_world_camera.translation() =
      aircraft.translation() - behind_m * ahead + above_m * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d gaze = std::cos(down_rad) * ahead - std::sin(down_rad) * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d right = gaze.cross(Eigen::Vector3d::UnitZ()).normalized();
  eye.T_world_camera.linear() << right, gaze.cross(right), gaze;

  self.update_scene(data, true);
  self.scene.camera[0] = self.scene.camera[1] = to_gl(eye);
  self.scene.stereo = mjSTEREO_NONE;
  self.gl.make_current(width_px, height_px);
  mjr_render({0, 0, width_px, height_px}, &self.scene, &self.renderer);
  self.gl.finish();
  cv::Mat view = colour_with_sky(self.gl.pixels(), eye);
  self.gl.make_current(2 * self.rig.width_px, self.rig.height_px);
  return view;
}

std::string StereoCameras::renderer() const { return implementation_->gl.renderer(); }

}  // namespace understory
