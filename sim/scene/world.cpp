#include "sim/scene/world.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>

#include "sim/scene/scenery.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

// MuJoCo's own handlers write a log file and wait for Enter.
[[noreturn]] void raise_error(const char* message) {
  throw SimulationError(std::string("MuJoCo: ") + message);
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read (the aircraft's MuJoCo model)");
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Files that mj_loadXML finds in memory. The structure is large: it lives on the heap.
class MemoryFiles {
 public:
  MemoryFiles() { mj_defaultVFS(files_.get()); }
  ~MemoryFiles() { mj_deleteVFS(files_.get()); }
  MemoryFiles(const MemoryFiles&) = delete;
  MemoryFiles& operator=(const MemoryFiles&) = delete;

  void add(const std::string& name, const std::string& content) {
    if (mj_makeEmptyFileVFS(files_.get(), name.c_str(), static_cast<int>(content.size())) != 0) {
      throw std::runtime_error("MuJoCo: no room for " + name + " in its table of files");
    }
    std::memcpy(files_->filedata[files_->nfile - 1], content.data(), content.size());
  }
  const mjVFS* get() const { return files_.get(); }

 private:
  std::unique_ptr<mjVFS> files_ = std::make_unique_for_overwrite<mjVFS>();
};

void write_wall(std::ostream& xml, std::size_t number, const Obstacle& wall) {
  const Eigen::Vector3d middle = 0.5 * (wall.from_world + wall.to_world), half = wall.to_world - middle;
  const Eigen::Vector3d along = Eigen::Vector3d(half.x(), half.y(), 0);
  const Eigen::Vector3d across(-along.y(), along.x(), 0);
  xml << "<geom name='obstacle_" << number << "' type='box' group='3' contype='0' conaffinity='1' condim='1'"
      << " size='" << along.norm() << ' ' << wall.radius_m << ' ' << std::abs(half.z()) << "' pos='"
      << middle.transpose() << "' xyaxes='" << along.transpose() << ' ' << across.transpose() << "'/>\n";
}

/// Bars are capsules: MuJoCo has exact routines for a capsule against the aircraft's boxes, none for a
/// cylinder.
void write_collisions(std::ostream& xml, const std::vector<Obstacle>& obstacles) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const Obstacle& obstacle = obstacles[i];
    if (obstacle.kind == ObstacleKind::box || obstacle.kind == ObstacleKind::sphere) {
      const Eigen::Quaterniond& turn = obstacle.turn_world;
      const bool box = obstacle.kind == ObstacleKind::box;
      const Eigen::Vector3d size = box ? obstacle.half_size_m : Eigen::Vector3d(obstacle.radius_m, 0, 0);
      xml << "<geom name='obstacle_" << i << "' type='" << word_for(obstacle.kind)
          << "' group='3' contype='0' conaffinity='1' condim='1' size='" << size.transpose() << "' pos='"
          << obstacle.T_world_box().translation().transpose() << "' quat='" << turn.w() << ' '
          << turn.vec().transpose() << "'/>\n";
      continue;
    }
    if (obstacle.kind == ObstacleKind::wall) {
      write_wall(xml, i, obstacle);
      continue;
    }
    xml << "<geom name='obstacle_" << i << "' type='capsule' group='3' contype='0' conaffinity='1' condim='1'"
        << " rgba='.4 .3 .2 1' size='" << obstacle.radius_m << "' fromto='" << obstacle.from_world.transpose()
        << ' ' << obstacle.to_world.transpose() << "'/>\n";
  }
}

/// Far below the ground until the aircraft places them.
void write_pool(std::ostream& xml) {
  for (int i = 0; i < pooled_geoms; ++i)
    xml << "<geom name='pool_" << i << "' type='capsule' group='3' contype='0' conaffinity='1' condim='1'"
        << " size='.1 1' pos='0 0 -1000'/>\n";
}

/// Whether one model is both drawn and flown.
enum class SceneUse { both, drawn, flown };

/// The extent is fixed, because the near and far planes depend on it (0.1 m and 120 m) and one more tree
/// would move them. No multisampling, because it ruins depth. Nothing is drawn into MuJoCo's own offscreen
/// buffer, so one pixel is enough. A contact (condim 1) is one row of constraints, and there are no others.
/// MuJoCo clears the memory for them in every mjData, four times a flight (53 MB each for a thousand), so it
/// is kept small.
std::string scene_xml(const Airframe& airframe, const std::vector<Obstacle>& obstacles,
                      const WorldConfig& config, SceneUse use) {
  const bool drawn = use != SceneUse::flown && config.scenery == Scenery::plain;
  const SceneryXml scenery = drawn ? scenery_xml(obstacles, config) : SceneryXml{};
  std::ostringstream xml;
  xml.imbue(std::locale::classic());
  xml.precision(17);
  xml << "<mujoco model='understory'>\n"
      << "<include file='delta_wing.xml'/>\n"
      << "<size nconmax='200' njmax='200'/>\n"
      << "<option timestep='" << 1.0 / physics_rate_hz << "' gravity='0 0 " << -airframe.gravity_mps2
      << "'/>\n"
      << "<statistic extent='50' center='0 0 0'/>\n"
      << "<visual><map znear='0.002' zfar='2.4'/><quality offsamples='0' shadowsize='1024'/>"
      << "<global offwidth='1' offheight='1'/></visual>\n"
      << "<asset>" << scenery.assets << "</asset>\n<worldbody>\n"
      << "<geom name='ground' type='plane' size='0 0 1' group='3' contype='0' conaffinity='1' condim='1'/>\n";
  const bool has_pool = use == SceneUse::flown || config.scenery == Scenery::woods;
  if (has_pool) write_pool(xml);
  if (config.obstacles_tangible && use != SceneUse::drawn) {
    std::vector<Obstacle> fixed = obstacles;
    if (has_pool)
      std::erase_if(fixed, [&](const Obstacle& obstacle) { return is_pooled(obstacle, obstacles); });
    write_collisions(xml, fixed);
  }
  xml << scenery.bodies << "\n</worldbody>\n</mujoco>\n";
  return xml.str();
}

/// Mass and inertia of the model file are replaced by the airframe's. The elevons (a millionth of a gram
/// each) are added, so MuJoCo's sum equals the airframe's to one part in 10^8.
void set_inertia(mjModel& model, const Airframe& airframe) {
  const int body = mj_name2id(&model, mjOBJ_BODY, "aircraft");
  model.body_mass[body] = airframe.mass_kg;
  for (int axis = 0; axis < 3; ++axis) model.body_inertia[3 * body + axis] = airframe.inertia_kgm2[axis];
  const mjStatistic pinned = model.stat;  // mj_setConst would recompute the extent, on which the view depends
  const DataPointer data(mj_makeData(&model));
  mj_setConst(&model, data.get());
  model.stat = pinned;
}

/// The wood fills the rectangle that its trees stand in.
std::shared_ptr<WoodsMesh> mesh_of(const std::vector<Obstacle>& obstacles, const std::vector<Tree>& trees,
                                   const WorldConfig& config, const Eigen::AlignedBox2d& course) {
  if (config.scenery == Scenery::plain) return nullptr;
  Eigen::AlignedBox2d stand;
  for (const Tree& tree : trees) stand.extend(Eigen::Vector2d(obstacles[tree.first].from_world.head<2>()));
  if (trees.empty()) stand = Eigen::AlignedBox2d(Eigen::Vector2d(0, -25), Eigen::Vector2d(60, 25));
  stand.extend(stand.max() + Eigen::Vector2d(1, 1));  // one tree alone would fill no area
  const std::uint64_t seed = trees.empty() ? 1 : trees.front().seed;
  auto mesh = std::make_shared<WoodsMesh>(woods_mesh(obstacles, trees, stand, course, config.woods, seed));
  const auto first = mesh->parts.begin();
  if (!config.obstacles_visible)
    mesh->parts.erase(first, first + static_cast<std::ptrdiff_t>(mesh->obstacle_parts));
  return mesh;
}

}  // namespace

void DeleteModel::operator()(mjModel_* model) const { mj_deleteModel(model); }
void DeleteData::operator()(mjData_* data) const { mj_deleteData(data); }

namespace {

ModelPointer compiled(const std::string& scene, const fs::path& aircraft_file) {
  MemoryFiles files;
  files.add("delta_wing.xml", text_of(aircraft_file));
  files.add("scene.xml", scene);
  char message[1000] = "";
  ModelPointer model(mj_loadXML("scene.xml", files.get(), message, sizeof message));
  if (!model) throw SimulationError(aircraft_file.string() + ": MuJoCo refuses the scene: " + message);
  for (const char* name : {"aircraft", "left_elevon", "right_elevon"}) {
    if (mj_name2id(model.get(), mjOBJ_BODY, name) < 0) {
      throw std::runtime_error(aircraft_file.string() + ": has no body named \"" + name + "\"");
    }
  }
  return model;
}

constexpr std::size_t many_obstacles = 500;

}  // namespace

bool is_pooled(const Obstacle& obstacle, const std::vector<Obstacle>& all) {
  const bool is_round = obstacle.kind != ObstacleKind::box && obstacle.kind != ObstacleKind::sphere &&
                        obstacle.kind != ObstacleKind::wall;
  return obstacle.tree >= 0 || (all.size() > many_obstacles && is_round);
}

World build_world(const fs::path& models_folder, const Airframe& airframe,
                  const std::vector<Obstacle>& obstacles, const WorldConfig& config,
                  const std::vector<Tree>& trees, const Eigen::AlignedBox2d& course) {
  mju_user_error = raise_error;
  mju_user_warning = raise_error;

  const fs::path aircraft_file = models_folder / "airframe" / "delta_wing.xml";
  const auto made = [&](SceneUse use) {
    ModelPointer model = compiled(scene_xml(airframe, obstacles, config, use), aircraft_file);
    set_inertia(*model, airframe);
    return model;
  };
  const bool large = config.scenery == Scenery::plain && obstacles.size() > many_obstacles;
  World world{made(large ? SceneUse::drawn : SceneUse::both), obstacles, config,
              mesh_of(obstacles, trees, config, course), large ? made(SceneUse::flown) : nullptr};
  world.model->vis.quality.shadowsize = 0;  // unused by the cameras, and expensive
  world.model->vis.quality.offsamples = 0;
  return world;
}

}  // namespace understory
