#include "sim/scene/scenery.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "sim/scene/meshes.hpp"

namespace understory {
namespace {

Obstacle bar(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m) {
  return {"bar", from, to, radius_m, 1.1, 0.3};
}

/// A trunk, a leaning trunk and a crossbar.
std::vector<Obstacle> bars() {
  return {bar({5, 1, 0}, {5, 1, 9}, 0.25), bar({8, -2, 0}, {9, -1, 7}, 0.1),
          bar({20, -3, 4}, {20, 3, 4}, 0.05)};
}

World world_of(const WorldConfig& config) {
  return build_world(std::filesystem::path(UNDERSTORY_SOURCE_DIR) / "models", Airframe{}, bars(), config);
}

TEST(Scenery, DrawnBarsCoverTheCollidingOnesToACentimetre) {
  const World world = world_of({});
  const mjModel& model = *world.model;
  const DataPointer data(mj_makeData(&model));
  mj_kinematics(&model, data.get());
  for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
    const Obstacle& obstacle = world.obstacles[i];
    const int geom = mj_name2id(&model, mjOBJ_GEOM, ("scenery_" + std::to_string(i)).c_str());
    ASSERT_GE(geom, 0);
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> turn(data->geom_xmat + 9 * geom);
    const Eigen::Map<const Eigen::Vector3d> at(data->geom_xpos + 3 * geom);
    const Eigen::Vector3d axis = (obstacle.to_world - obstacle.from_world).normalized();
    const double length = (obstacle.to_world - obstacle.from_world).norm();
    const int mesh = model.geom_dataid[geom];
    double lowest = 1e9, highest = -1e9;
    for (int v = 0; v < model.mesh_vertnum[mesh]; ++v) {
      const Eigen::Map<const Eigen::Vector3f> local(model.mesh_vert + 3 * (model.mesh_vertadr[mesh] + v));
      const Eigen::Vector3d from_foot = turn * local.cast<double>() + at - obstacle.from_world;
      const double along = axis.dot(from_foot);
      lowest = std::min(lowest, along);
      highest = std::max(highest, along);
      EXPECT_NEAR((from_foot - along * axis).norm(), obstacle.radius_m, 0.0066);
    }
    EXPECT_NEAR(lowest, 0, 1e-4);
    EXPECT_NEAR(highest, length, 1e-4);
  }
}

TEST(Scenery, TouchesNothingAndIsInItsGroup) {
  const World world = world_of({});
  int drawn = 0;
  for (int geom = 0; geom < world.model->ngeom; ++geom) {
    const char* name = mj_id2name(world.model.get(), mjOBJ_GEOM, geom);
    if (name == nullptr || std::string(name).rfind("scenery_", 0) != 0) continue;
    ++drawn;
    EXPECT_EQ(world.model->geom_contype[geom], 0);
    EXPECT_EQ(world.model->geom_conaffinity[geom], 0);
    EXPECT_EQ(world.model->geom_group[geom], group_scenery);
  }
  EXPECT_EQ(drawn, 4);  // the ground and three bars
}

TEST(Scenery, InvisibleObstaclesAreNotDrawn) {
  WorldConfig config;
  config.obstacles_visible = false;
  const World world = world_of(config);
  EXPECT_LT(mj_name2id(world.model.get(), mjOBJ_GEOM, "scenery_0"), 0);
  EXPECT_GE(mj_name2id(world.model.get(), mjOBJ_GEOM, "scenery_ground"), 0);
}

TEST(Scenery, ModelsTexturesHaveTheConfiguredContrast) {
  WorldConfig config;
  config.bark_contrast = 0.2;
  config.ground_contrast = 0.4;
  const World world = world_of(config);
  paint_textures(*world.model, world.config);
  const auto contrast = [&](const char* name) {
    const int id = mj_name2id(world.model.get(), mjOBJ_TEXTURE, name);
    const mjtByte* rgb = world.model->tex_rgb + world.model->tex_adr[id];
    const int count = world.model->tex_width[id] * world.model->tex_height[id];
    double sum = 0, squares = 0;
    for (int i = 0; i < count; ++i) {
      const double green = rgb[3 * i + 1];
      sum += green;
      squares += green * green;
    }
    const double mean = sum / count;
    return std::sqrt(squares / count - mean * mean) / mean;
  };
  EXPECT_NEAR(contrast("bark"), 0.2, 0.004);
  EXPECT_NEAR(contrast("litter"), 0.4, 0.008);
}

/// What stands in the tile, read where facade.hpp says it stands.
TEST(Facade, WindowsArePanesInFrames) {
  const GrayTexture tile = facade_texture(3);
  const auto gray_at = [&](double x_m, double z_m) {
    const int column = static_cast<int>((x_m + 0.5 * window_period_m) / window_period_m * tile.width_px);
    const int row = static_cast<int>((storey_m - z_m) / storey_m * tile.height_px);
    return static_cast<int>(tile.gray.at(static_cast<std::size_t>(row * tile.width_px + column)));
  };
  for (const double z_m : {1.25, 1.8, 2.35})
    for (const double x_m : {-0.18, 0.18}) EXPECT_LT(gray_at(x_m, z_m), 60);
  EXPECT_GT(gray_at(0, 1.25), 200);
  EXPECT_NEAR(gray_at(0.55, 1.25), 165, 20);
  EXPECT_LT(gray_at(0, 2.75), 130);  // the lintel, above the panes
}

TEST(Facade, IsClosedAndFacesOutward) {
  const TrunkMesh mesh = facade_mesh({"wall", {3, -2, 0}, {3, 4, 5}, 0.2, 0, 0, ObstacleKind::wall});
  double six_volumes = 0;
  for (const auto& face : mesh.faces)
    six_volumes += mesh.vertices[face[0]].dot(mesh.vertices[face[1]].cross(mesh.vertices[face[2]]));
  EXPECT_NEAR(six_volumes / 6, 6 * 5 * 0.4, 1e-9);
  double minimum = 1e9, maximum = -1e9;
  for (const auto& texture : mesh.texture) {
    minimum = std::min(minimum, texture.x());
    maximum = std::max(maximum, texture.x());
  }
  EXPECT_NEAR(maximum - minimum, 6 / window_period_m, 1e-12);
}

TEST(TrunkMesh, IsClosedAndFacesOutward) {
  const TrunkMesh mesh = trunk_mesh(bar({0, 0, 1}, {0, 0, 4}, 0.2), 0.8, 1.6);
  double six_volumes = 0;  // divergence theorem: right only if every face is there and turns outward
  for (const auto& face : mesh.faces)
    six_volumes += mesh.vertices[face[0]].dot(mesh.vertices[face[1]].cross(mesh.vertices[face[2]]));
  EXPECT_NEAR(six_volumes / 6, std::numbers::pi * 0.2 * 0.2 * 3, 0.07 * 0.377);
  // Round the trunk the bark fits a whole number of times.
  double turns = 0;
  for (const auto& texture : mesh.texture) turns = std::max(turns, texture.x());
  EXPECT_DOUBLE_EQ(turns, 2);  // girth 1.26 m over 0.8 m
}

}  // namespace
}  // namespace understory
