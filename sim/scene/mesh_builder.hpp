#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <random>
#include <vector>

#include "sim/scene/woods_mesh.hpp"

namespace understory {

/// Smooth noise over the place, -1 .. 1, the same for the same place and seed.
double noise_at(const Eigen::Vector2d& place, std::uint32_t seed);

/// A flat picture of leaves: its middle, and from there half of its width and of its height.
struct Card {
  Eigen::Vector3d middle, x, y;
  LeafPicture picture = LeafPicture::leaves;
};

/// Fills a WoodsMesh with tubes and cards, part by part. Light is computed here, once: sun and sky by the
/// surface's direction, patches of sun by the place.
class MeshBuilder {
 public:
  MeshBuilder(const WoodsConfig& config, std::uint64_t seed);

  double uniform(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(generator_);
  }
  /// Height of the ground, m: flat under no tree, and no higher than the plane that MuJoCo collides with.
  double ground_z(const Eigen::Vector2d& place) const;
  /// Sun and sky on a surface with this normal, over the tint.
  Eigen::Vector3d lit(const Eigen::Vector3d& tint, const Eigen::Vector3d& normal) const;

  void begin_part(WoodsTexture texture);
  void end_part() {
    part_.whole_world = part_.box_world;
    mesh.parts.push_back(part_);
  }
  WoodsPart& part() { return part_; }

  /// Grows a piece of the mesh. `grow` may be called again after the mesh is made.
  void add_piece(std::function<void(MeshBuilder&)> grow);
  /// The triangles of a piece, as they were when it was added.
  const WoodsTriangles& grown_again(const WoodsPiece& piece);

  /// Calls `add` and returns the indices that it added as a range.
  template <typename Add>
  WoodsRange range_of(Add&& add) {
    WoodsRange range{static_cast<std::uint32_t>(triangles.indices.size())};
    add();
    range.count = static_cast<std::uint32_t>(triangles.indices.size()) - range.first;
    return range;
  }

  /// Around the corners of these triangles.
  Eigen::AlignedBox3d box_of(const WoodsRange& range) const;

  std::uint32_t add_vertex(const Eigen::Vector3d& place, double u, double v, const Eigen::Vector3d& tint,
                           std::uint16_t object);
  void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
  /// A tube along points with radii. Corners lie as far outside the circle as edges lie inside.
  void add_tube(const std::vector<Eigen::Vector3d>& axis, const std::vector<double>& radii_m, int sides,
                const Eigen::Vector3d& tint, double turn_rad, std::uint16_t object);
  /// The same tube from far away: a strip that the drawing turns to the eye.
  void add_ribbon(const std::vector<Eigen::Vector3d>& axis, const std::vector<double>& radii_m,
                  const Eigen::Vector3d& tint, std::uint16_t object);
  /// The tints are of its lower and its upper edge.
  void add_card(const Card& card, const Eigen::Vector3d& low_tint, const Eigen::Vector3d& high_tint,
                std::uint16_t object);

  WoodsMesh mesh;
  WoodsTriangles triangles;  ///< of the piece that grows
  std::uint32_t noise_seed;

 private:
  double sun_at(const Eigen::Vector3d& place) const;

  std::mt19937_64 generator_;
  std::size_t kept_bytes_ = 0;
  double sun_share_;  ///< of the light that comes straight from the sun
  WoodsPicture dapple_;
  WoodsPart part_;
};

/// What woods are grown from. Pieces that are grown again share it.
struct WoodsPlan {
  std::vector<Obstacle> obstacles;
  std::vector<Tree> trees;
  WoodsConfig config;
};

/// A tree beyond the course, out of the aircraft's reach: a stem of few sides and large squares of leaves.
void add_far_tree(MeshBuilder& builder, const Tree& tree, double radius_m, const Eigen::Vector2d& place,
                  const WoodsConfig& config, std::uint16_t number);

/// Patches of ground with their plants and fallen logs, out to where trees hide the rim, and the far wood
/// with thickets between its trees, which are like those of the stand. No far tree and no
/// thicket stands within the course (an empty box: anywhere).
void add_forest_floor(MeshBuilder& builder, const std::shared_ptr<const WoodsPlan>& plan,
                      const Eigen::AlignedBox2d& stand, const Eigen::AlignedBox2d& course);

}  // namespace understory
