#include "sim/scene/scenery.hpp"

#include <mujoco/mujoco.h>

#include <fmt/core.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "sim/scene/meshes.hpp"
#include "sim/scene/textures.hpp"

namespace understory {
namespace {

constexpr double ground_reach_m = 400.0;  // beyond it the sky begins at the horizon

// Gray levels in full light; with the sun of the cameras' scene trunks come out near 100 and the ground near
// 120.
constexpr double bark_gray = 132;
constexpr double ground_gray = 129;

TextureRequest bark_request(const WorldConfig& config) {
  return {.width_px = 256,
          .height_px = 512,
          .mean_gray = bark_gray,
          .contrast = config.bark_contrast,
          .coarsest_cells = 1,
          .octaves = 7,
          .elongation = 2.5,
          .fissures = true,
          .seed = config.texture_seed};
}

TextureRequest ground_request(const WorldConfig& config) {
  return {.width_px = 1024,
          .height_px = 1024,
          .mean_gray = ground_gray,
          .contrast = config.ground_contrast,
          .coarsest_cells = 4,
          .octaves = 8,
          .elongation = 1,
          .fissures = false,
          .seed = config.texture_seed + 1};
}

/// Tints over gray. The cameras read only green, so the colours are for people.
struct Tint {
  double red, blue;
};

void paint(mjModel& model, const char* name, const GrayTexture& texture, const Tint& tint) {
  const int id = mj_name2id(&model, mjOBJ_TEXTURE, name);
  const auto tinted = [](std::uint8_t gray, double factor) {
    return static_cast<mjtByte>(std::min(255.0, gray * factor));
  };
  mjtByte* rgb = model.tex_rgb + model.tex_adr[id];
  for (const std::uint8_t gray : texture.gray) {
    *rgb++ = tinted(gray, tint.red);
    *rgb++ = gray;
    *rgb++ = tinted(gray, tint.blue);
  }
}

/// Real numbers with seven digits, as MuJoCo stores them.
template <typename Vectors>
std::string numbers(const Vectors& vectors) {
  std::string text;
  for (const auto& vector : vectors)
    for (const auto value : vector)
      fmt::format_to(std::back_inserter(text), "{:.7g} ", static_cast<double>(value));
  return text;
}

std::string mesh_xml(const std::string& name, const TrunkMesh& mesh) {
  return fmt::format("<mesh name=\"{}\" vertex=\"{}\" normal=\"{}\" texcoord=\"{}\" face=\"{}\"/>\n", name,
                     numbers(mesh.vertices), numbers(mesh.normals), numbers(mesh.texture),
                     numbers(mesh.faces));
}

std::string geom_xml(const std::string& name, const char* material, const Eigen::Vector3d& at,
                     const Eigen::Quaterniond& turn) {
  return fmt::format(
      "<geom name=\"{0}\" type=\"mesh\" mesh=\"{0}\" material=\"{1}\" contype=\"0\" conaffinity=\"0\" "
      "group=\"{2}\" mass=\"0\" pos=\"{3:.9g} {4:.9g} {5:.9g}\" quat=\"{6:.9g} {7:.9g} {8:.9g} {9:.9g}\"/>\n",
      name, material, static_cast<int>(group_scenery), at.x(), at.y(), at.z(), turn.w(), turn.x(), turn.y(),
      turn.z());
}

/// A slab, because MuJoCo compiles no mesh without volume. Only its upper face is seen.
TrunkMesh ground_mesh() {
  TrunkMesh mesh;
  for (const double z : {-1.0, 0.0})
    for (const double y : {-ground_reach_m, ground_reach_m})
      for (const double x : {-ground_reach_m, ground_reach_m}) {
        mesh.vertices.emplace_back(x, y, z);
        mesh.normals.emplace_back(0, 0, 1);
        mesh.texture.emplace_back(x / ground_tile_m, y / ground_tile_m);
      }
  for (const auto& face :
       {Eigen::Vector4i(4, 5, 7, 6), Eigen::Vector4i(0, 2, 3, 1), Eigen::Vector4i(0, 1, 5, 4),
        Eigen::Vector4i(2, 6, 7, 3), Eigen::Vector4i(0, 4, 6, 2), Eigen::Vector4i(1, 3, 7, 5)}) {
    mesh.faces.emplace_back(face[0], face[1], face[2]);
    mesh.faces.emplace_back(face[0], face[2], face[3]);
  }
  return mesh;
}

std::string texture_xml(const char* name, int width_px, int height_px) {
  return fmt::format(
      "<texture name=\"{0}\" type=\"2d\" builtin=\"flat\" rgb1=\".5 .5 .5\" width=\"{1}\" height=\"{2}\"/>\n"
      "<material name=\"{0}\" texture=\"{0}\" specular=\"0\" shininess=\"0\" reflectance=\"0\"/>\n",
      name, width_px, height_px);
}

/// The smallest rotation that takes the z axis onto a unit vector. Eigen's FromTwoVectors is the same to the
/// bit, but compiles a singular value decomposition for the vector straight down.
Eigen::Quaterniond turn_from_z(const Eigen::Vector3d& unit) {
  const double twice_cosine = std::sqrt((1 + unit.z()) * 2);  // of half the angle
  if (twice_cosine < 1e-6) return Eigen::Quaterniond(0, 1, 0, 0);
  Eigen::Quaterniond turn;
  turn.vec() = Eigen::Vector3d::UnitZ().cross(unit) * (1 / twice_cosine);
  turn.w() = twice_cosine * 0.5;
  return turn;
}

}  // namespace

SceneryXml scenery_xml(const std::vector<Obstacle>& obstacles, const WorldConfig& config) {
  SceneryXml xml;
  const TextureRequest bark = bark_request(config), litter = ground_request(config);
  xml.assets = texture_xml("bark", bark.width_px, bark.height_px) +
               texture_xml("litter", litter.width_px, litter.height_px) +
               mesh_xml("scenery_ground", ground_mesh());
  xml.bodies = geom_xml("scenery_ground", "litter", Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity());
  if (!config.obstacles_visible) return xml;
  bool has_facade = false;  // only scenes with one need its texture
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const Obstacle& obstacle = obstacles[i];
    const std::string name = fmt::format("scenery_{}", i);
    if (obstacle.kind == ObstacleKind::wall) {
      if (!has_facade) xml.assets += texture_xml("facade", facade_width_px, facade_height_px);
      has_facade = true;
      xml.assets += mesh_xml(name, facade_mesh(obstacle));
      xml.bodies += geom_xml(name, "facade", obstacle.from_world, Eigen::Quaterniond::Identity());
      continue;
    }
    if (obstacle.kind >= ObstacleKind::capsule) {                  // of the scenario's own list
      constexpr std::array materials{"bark", "facade", "litter"};  // by ObstacleTexture
      const bool windowed = obstacle.texture == ObstacleTexture::windows;
      if (windowed && !has_facade) xml.assets += texture_xml("facade", facade_width_px, facade_height_px);
      has_facade = has_facade || windowed;
      xml.assets += mesh_xml(name, listed_mesh(obstacle));
      xml.bodies += geom_xml(name, materials[static_cast<std::size_t>(obstacle.texture)],
                             obstacle.T_world_box().translation(), obstacle.turn_world);
      continue;
    }
    const Eigen::Quaterniond turn = turn_from_z((obstacle.to_world - obstacle.from_world).normalized()) *
                                    Eigen::AngleAxisd(obstacle.texture_turn_rad, Eigen::Vector3d::UnitZ());
    xml.assets += mesh_xml(name, trunk_mesh(obstacle, bark_width_m, bark_height_m));
    xml.bodies += geom_xml(name, "bark", obstacle.from_world, turn);
  }
  return xml;
}

void paint_textures(mjModel& model, const WorldConfig& config) {
  const auto has = [&](const char* texture) { return mj_name2id(&model, mjOBJ_TEXTURE, texture) >= 0; };
  if (has("bark")) paint(model, "bark", make_texture(bark_request(config)), {1.06, 0.88});
  if (has("litter")) paint(model, "litter", make_texture(ground_request(config)), {0.90, 0.72});
  if (has("facade")) paint(model, "facade", facade_texture(config.texture_seed + 2), {1.04, 0.94});
}

}  // namespace understory
