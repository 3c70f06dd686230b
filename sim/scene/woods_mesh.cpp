#include "sim/scene/woods_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "sim/scene/woods_textures.hpp"

namespace understory {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double bark_width_m = 0.7, bark_height_m = 1.4;  ///< of one tile
constexpr double ground_tile_m = 4, cell_m = 2;
constexpr int cells_per_patch = 5;
constexpr double far_reach_m = 45;  ///< how far the wood goes on beyond the stand
constexpr double relief_m = 0.12;

/// Colours of a kind: bark over its gray texture, leaves. Tints are over 128.
struct Colours {
  Vector3d bark, leaves;
};
const std::array<Colours, 5> colours{{{{118, 108, 96}, {98, 128, 56}},
                                      {{140, 138, 130}, {110, 140, 62}},
                                      {{190, 188, 180}, {126, 150, 70}},
                                      {{138, 104, 78}, {84, 112, 66}},
                                      {{106, 94, 84}, {62, 92, 56}}}};

/// Smooth noise of place, -1 .. 1, the same for the same place and seed.
double noise_at(const Vector2d& place, std::uint32_t seed) {
  const auto node = [&](std::int64_t x, std::int64_t y) {
    std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u ^
                      static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fu ^ seed;
    h = (h ^ (h >> 31)) * 0xbf58476d1ce4e5b9u;
    return static_cast<double>((h ^ (h >> 29)) & 0xffff) / 32767.5 - 1;
  };
  const auto x = static_cast<std::int64_t>(std::floor(place.x())),
             y = static_cast<std::int64_t>(std::floor(place.y()));
  const double u = place.x() - std::floor(place.x()), v = place.y() - std::floor(place.y());
  const double s = u * u * (3 - 2 * u), t = v * v * (3 - 2 * v);
  const double low = node(x, y) + s * (node(x + 1, y) - node(x, y));
  const double high = node(x, y + 1) + s * (node(x + 1, y + 1) - node(x, y + 1));
  return low + t * (high - low);
}

class Builder {
 public:
  Builder(const std::vector<Obstacle>& obstacles, const std::vector<Tree>& trees,
          const Eigen::AlignedBox2d& stand, const WoodsConfig& config, std::uint64_t seed)
      : obstacles_(obstacles),
        trees_(trees),
        stand_(stand),
        config_(config),
        generator_(seed),
        seed_(static_cast<std::uint32_t>(seed)) {
    numbers_.trees = trees.size();
    const double azimuth = uniform(0, 2 * std::numbers::pi), up = config.sun_elevation_rad;
    mesh_.to_sun_world = {std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth), std::sin(up)};
    mesh_.haze_m = config.haze_m;
  }

  WoodsMesh build() {
    for (std::size_t i = 0; i < trees_.size(); ++i) add_tree(i);
    add_far_wood();
    add_ground();
    for (std::size_t i = 0; i < woods_texture_count; ++i) {
      const auto uses = [&](const WoodsPart& part) { return part.texture == static_cast<WoodsTexture>(i); };
      if (static_cast<WoodsTexture>(i) == WoodsTexture::leaves || std::ranges::any_of(mesh_.parts, uses))
        mesh_.textures[i] = woods_picture(static_cast<WoodsTexture>(i), seed_);
    }
    mesh_.dapple = dapple_picture(seed_);
    return std::move(mesh_);
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(generator_);
  }

  double ground_z(const Vector2d& place) const {
    // Flat under the launch and no higher than the plane that MuJoCo collides with.
    return relief_m * (noise_at(place / 7, seed_) + 0.5 * noise_at(place / 3, seed_ + 1) - 1.5);
  }

  /// Sun and sky on a surface with this normal, over the tint.
  Vector3d lit(const Vector3d& tint, const Vector3d& normal) const {
    const double sun = std::max(0.0, normal.dot(mesh_.to_sun_world)), sky = 0.5 + 0.5 * normal.z();
    return tint * (0.45 + 0.25 * sky + 0.45 * sun);
  }

  std::uint32_t add_vertex(const Vector3d& place, double u, double v, const Vector3d& tint, double dapple,
                           std::uint16_t object) {
    WoodsVertex vertex{};
    for (int i = 0; i < 3; ++i) {
      vertex.position_world[i] = static_cast<float>(place[i]);
      vertex.tint[i] = static_cast<std::uint8_t>(std::clamp(tint[i], 0.0, 255.0));
    }
    vertex.tint[3] = static_cast<std::uint8_t>(255 * dapple);
    vertex.texture = {static_cast<float>(u), static_cast<float>(v)};
    vertex.object = {static_cast<std::uint8_t>(object & 255), static_cast<std::uint8_t>(object >> 8), 0, 255};
    mesh_.vertices.push_back(vertex);
    part_.box_world.extend(place);
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }
  void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    for (const std::uint32_t index : {a, b, c, a, c, d}) mesh_.indices.push_back(index);
  }

  /// Adds what `add` adds, as a range.
  template <typename Add>
  WoodsRange range_of(Add&& add) {
    WoodsRange range{static_cast<std::uint32_t>(mesh_.indices.size())};
    add();
    range.count = static_cast<std::uint32_t>(mesh_.indices.size()) - range.first;
    return range;
  }

  /// A tube along points with radii. Corners lie as far outside the circle as edges lie inside.
  void add_tube(const std::vector<Vector3d>& axis, const std::vector<double>& radii_m, int sides,
                const Vector3d& tint, double turn_rad, std::uint16_t object) {
    const double outside = 2 / (1 + std::cos(std::numbers::pi / sides));
    const double around = std::max(1.0, std::round(2 * std::numbers::pi * radii_m.front() / bark_width_m));
    double along_m = 0;
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < axis.size(); ++i) {
      if (i > 0) along_m += (axis[i] - axis[i - 1]).norm();
      const Vector3d direction =
          (axis[std::min(i + 1, axis.size() - 1)] - axis[i > 0 ? i - 1 : 0]).normalized();
      // The same direction for every ring, or the bark would twist where the axis bends.
      const Vector3d reference = std::abs(direction.z()) > 0.7 ? Vector3d::UnitX() : Vector3d::UnitZ();
      const Vector3d side = (reference - reference.dot(direction) * direction).normalized();
      const Vector3d other = direction.cross(side);
      const auto ring = static_cast<std::uint32_t>(mesh_.vertices.size());
      for (int corner = 0; corner <= sides; ++corner) {
        const double angle = turn_rad + 2 * std::numbers::pi * corner / sides;
        const Vector3d out = std::cos(angle) * side + std::sin(angle) * other;
        add_vertex(axis[i] + outside * radii_m[i] * out, around * corner / sides, along_m / bark_height_m,
                   lit(tint, out), 1, object);
      }
      for (int corner = 0; i > 0 && corner < sides; ++corner) {
        const auto low = before + static_cast<std::uint32_t>(corner),
                   high = ring + static_cast<std::uint32_t>(corner);
        add_quad(low, low + 1, high + 1, high);
      }
      before = ring;
    }
  }

  /// A square of leaves about a place, facing `normal`: one of the four pictures of the leaves' texture.
  void add_leaves(const Vector3d& place, const Vector3d& normal, double size_m, const Vector3d& tint,
                  int picture, double dapple, std::uint16_t object) {
    const Vector3d side = normal.unitOrthogonal(), up = normal.cross(side);
    const double turn = uniform(0, 2 * std::numbers::pi);
    const Vector3d x = 0.5 * size_m * (std::cos(turn) * side + std::sin(turn) * up),
                   y = 0.5 * size_m * (std::cos(turn) * up - std::sin(turn) * side);
    add_card(place, x, y, tint, tint, picture, dapple, object);
  }
  void add_card(const Vector3d& place, const Vector3d& x, const Vector3d& y, const Vector3d& low_tint,
                const Vector3d& high_tint, int picture, double dapple, std::uint16_t object) {
    const double u = 0.5 * (picture & 1), v = 0.5 * (picture >> 1);
    constexpr double inset = 0.004;
    add_quad(add_vertex(place - x - y, u + inset, v + inset, low_tint, dapple, object),
             add_vertex(place + x - y, u + 0.5 - inset, v + inset, low_tint, dapple, object),
             add_vertex(place + x + y, u + 0.5 - inset, v + 0.5 - inset, high_tint, dapple, object),
             add_vertex(place - x + y, u + inset, v + 0.5 - inset, high_tint, dapple, object));
  }

  /// The crown's leaves: squares spread through its hull, brighter above and towards the sun.
  void add_crown(const Tree& tree, const Vector3d& foot, const Vector3d& top, int squares, double size_m,
                 std::uint16_t object) {
    const bool conifer = tree.kind == TreeKind::pine || tree.kind == TreeKind::spruce;
    const Vector3d& tint = colours[static_cast<std::size_t>(tree.kind)].leaves;
    const double base_m =
        tree.kind == TreeKind::pine ? std::max(tree.crown_base_m, 0.6 * tree.height_m) : tree.crown_base_m;
    const double depth_m = std::max(tree.height_m - base_m, 1.0);
    for (int i = 0; i < squares; ++i) {
      const double share = tree.kind == TreeKind::spruce ? 1 - std::sqrt(uniform(0, 1)) : uniform(0, 1);
      // The hull's radius over its height: a cone, or an egg that is widest below its middle.
      const double hull = tree.kind == TreeKind::spruce
                              ? 1 - share
                              : std::sqrt(std::max(0.0, 1 - std::pow(1.7 * share - 0.7, 2)));
      const double out = std::sqrt(uniform(conifer ? 0.05 : 0.25, 1.0)) * hull * tree.crown_radius_m;
      const double turn = uniform(0, 2 * std::numbers::pi);
      const Vector3d outward(std::cos(turn), std::sin(turn), 0);
      const Vector3d stem = foot + (base_m + share * depth_m) / tree.height_m * (top - foot);
      const Vector3d normal = (outward * uniform(0.2, 1) + Vector3d(uniform(-0.4, 0.4), uniform(-0.4, 0.4),
                                                                    conifer ? 1.2 : uniform(-0.2, 1.0)))
                                  .normalized();
      const double shade =
          0.55 + 0.45 * share + 0.12 * uniform(-1, 1) + 0.15 * outward.dot(mesh_.to_sun_world) * hull;
      add_leaves(stem + out * outward, normal, size_m * uniform(0.7, 1.3), shade * tint, conifer ? 2 : i & 1,
                 0.3, object);
    }
  }

  std::vector<Vector3d> points_of(std::size_t first, std::size_t pieces) const {
    std::vector<Vector3d> points{obstacles_[first].from_world};
    for (std::size_t i = 0; i < pieces; ++i) points.push_back(obstacles_[first + i].to_world);
    return points;
  }

  /// The drawn stem: the obstacles' axis with the radius between theirs, root flare, and on to the tree's
  /// top.
  void stem_of(const Tree& tree, std::vector<Vector3d>& axis, std::vector<double>& radii_m) const {
    axis = points_of(tree.first, tree.trunk_pieces);
    const auto radius_of = [&](std::size_t i) {
      return obstacles_[tree.first + std::min(i, tree.trunk_pieces - 1)].radius_m;
    };
    for (std::size_t i = 0; i < axis.size(); ++i)
      radii_m.push_back(i == 0 ? radius_of(0) : 0.5 * (radius_of(i - 1) + radius_of(i)));
    const Vector3d direction = (axis.back() - axis[axis.size() - 2]).normalized();
    const Vector3d top = axis.back() + direction * std::max(0.5, tree.height_m - axis.back().z());
    axis.push_back(top);
    radii_m.push_back(0.02);
    axis.insert(axis.begin() + 1, axis[0] + 0.35 * (axis[1] - axis[0]).normalized());
    radii_m.insert(radii_m.begin() + 1, 1.06 * radii_m[0]);
    radii_m[0] *= 1.35;
    axis[0].z() -= 2 * relief_m;
  }

  void add_tree(std::size_t number) {
    const Tree& tree = trees_[number];
    part_ = {};
    part_.texture = static_cast<WoodsTexture>(tree.kind);
    const Vector3d tint = colours[static_cast<std::size_t>(tree.kind)].bark * uniform(0.85, 1.15);
    const Obstacle& foot = obstacles_[tree.first];
    std::vector<Vector3d> axis;
    std::vector<double> radii_m;
    stem_of(tree, axis, radii_m);
    const auto solid = [&](int sides, bool with_branches) {
      add_tube(axis, radii_m, sides, tint, foot.texture_turn_rad, numbers_.trunk(number));
      for (std::size_t i = tree.first + tree.trunk_pieces;
           with_branches && i < tree.first + tree.trunk_pieces + tree.branches; ++i)
        add_tube({obstacles_[i].from_world, obstacles_[i].to_world},
                 {obstacles_[i].radius_m, 0.8 * obstacles_[i].radius_m}, 4, 0.85 * tint, 0,
                 numbers_.branch(number));
    };
    part_.solid = {range_of([&] { solid(8, true); }), range_of([&] { solid(5, false); })};
    const auto leaves = [&](int squares, double size_m) {
      add_crown(tree, axis.front(), axis.back(), squares, size_m, numbers_.leaves(number));
    };
    part_.leaves = {range_of([&] {
                      leaves(110, 1.1);
                      add_leaves_of_branches(number);
                    }),
                    range_of([&] { leaves(18, 2.4); })};
    mesh_.parts.push_back(part_);
  }

  void add_leaves_of_branches(std::size_t number) {
    const Tree& tree = trees_[number];
    const bool conifer = tree.kind == TreeKind::pine || tree.kind == TreeKind::spruce;
    const Vector3d tint = 0.75 * colours[static_cast<std::size_t>(tree.kind)].leaves;
    for (std::size_t i = tree.first + tree.trunk_pieces; i < tree.first + tree.trunk_pieces + tree.branches;
         ++i) {
      if (obstacles_[i].from_world.z() < tree.crown_base_m - 0.01) continue;  // a dead stub
      for (int square = 0; square < 4; ++square) {
        const Vector3d place = obstacles_[i].from_world +
                               uniform(0.3, 1.05) * (obstacles_[i].to_world - obstacles_[i].from_world);
        add_leaves(place, Vector3d(uniform(-0.6, 0.6), uniform(-0.6, 0.6), 1).normalized(), uniform(0.5, 0.9),
                   tint, conifer ? 2 : square & 1, 0.6, numbers_.leaves(number));
      }
    }
  }

  /// Trees beyond the course that nobody can reach: a stem of few sides and large squares of leaves.
  void add_far_wood() {
    const std::vector<Tree>& models = trees_;
    if (models.empty()) return;
    const Eigen::AlignedBox2d reach(stand_.min() - Vector2d::Constant(far_reach_m),
                                    stand_.max() + Vector2d::Constant(far_reach_m));
    const double density = std::max(0.01, static_cast<double>(models.size()) / stand_.volume());
    const int count = static_cast<int>(0.5 * density * reach.volume());
    for (int i = 0; i < count; ++i) {
      const Vector2d place(uniform(reach.min().x(), reach.max().x()),
                           uniform(reach.min().y(), reach.max().y()));
      const auto pick = static_cast<std::size_t>(uniform(0, 1) * 0.999 * static_cast<double>(models.size()));
      const double lean = uniform(-0.6, 0.6), turn = uniform(0, 6);
      // Not where the aircraft flies, and not in the clearing of the launch.
      const Eigen::AlignedBox2d course(Vector2d(stand_.min() - Vector2d(18, 1)),
                                       Vector2d(stand_.max() + Vector2d(4, 1)));
      if (course.contains(place) || (place.x() < stand_.min().x() && std::abs(place.y()) < 8)) continue;
      Tree tree = models[pick];
      part_ = {};
      part_.texture = static_cast<WoodsTexture>(tree.kind);
      const Vector3d foot(place.x(), place.y(), -2 * relief_m),
          top = foot + Vector3d(lean, -lean, tree.height_m);
      const double radius_m = obstacles_[tree.first].radius_m;
      const WoodsRange stem = range_of([&] {
        add_tube({foot, top}, {1.1 * radius_m, 0.02}, 5, colours[static_cast<std::size_t>(tree.kind)].bark,
                 turn, numbers_.far_wood());
      });
      const WoodsRange crown = range_of([&] { add_crown(tree, foot, top, 10, 3.2, numbers_.far_wood()); });
      part_.solid = {stem, stem};
      part_.leaves = {crown, crown};
      mesh_.parts.push_back(part_);
    }
  }

  /// Patches of ground with their plants, out to where haze and trees hide the rim.
  void add_ground() {
    const double patch_m = cells_per_patch * cell_m;
    const Vector2d low = (stand_.min() - Vector2d::Constant(far_reach_m + 25)) / patch_m,
                   high = (stand_.max() + Vector2d::Constant(far_reach_m + 25)) / patch_m;
    for (int row = static_cast<int>(std::floor(low.y())); row < high.y(); ++row)
      for (int column = static_cast<int>(std::floor(low.x())); column < high.x(); ++column)
        add_patch(Vector2d(column, row) * patch_m);
  }

  void add_patch(const Vector2d& corner) {
    part_ = {};
    const Vector3d soil(104, 96, 74);
    const WoodsRange ground = range_of([&] {
      std::array<std::array<std::uint32_t, cells_per_patch + 1>, cells_per_patch + 1> at{};
      for (int row = 0; row <= cells_per_patch; ++row)
        for (int column = 0; column <= cells_per_patch; ++column) {
          const Vector2d place = corner + cell_m * Vector2d(column, row);
          const Vector3d normal =
              Vector3d(ground_z(place - Vector2d(0.5, 0)) - ground_z(place + Vector2d(0.5, 0)),
                       ground_z(place - Vector2d(0, 0.5)) - ground_z(place + Vector2d(0, 0.5)), 1)
                  .normalized();
          const double moss = 0.5 + 0.5 * noise_at(place / 5, seed_ + 7);
          at[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = add_vertex(
              {place.x(), place.y(), ground_z(place)}, place.x() / ground_tile_m, place.y() / ground_tile_m,
              lit(soil + moss * Vector3d(-14, 18, -12), normal), 1, object_ground);
        }
      for (std::size_t row = 0; row < cells_per_patch; ++row)
        for (std::size_t column = 0; column < cells_per_patch; ++column)
          add_quad(at[row][column], at[row][column + 1], at[row + 1][column + 1], at[row + 1][column]);
    });
    const double patch_m = cells_per_patch * cell_m;
    const WoodsRange plants = range_of([&] {
      const int count = static_cast<int>(config_.undergrowth * patch_m * patch_m * 0.35);
      for (int i = 0; i < count; ++i) {
        const Vector2d place = corner + patch_m * Vector2d(uniform(0, 1), uniform(0, 1));
        const double grows = 0.5 + 0.5 * noise_at(place / 4, seed_ + 3),
                     size_m = uniform(0.25, 0.45) + 0.5 * grows * uniform(0, 1);
        const Vector3d tint = (0.6 + 0.4 * grows) * Vector3d(96, 124, 58) * uniform(0.8, 1.1);
        if (grows < uniform(0.1, 0.6)) continue;
        add_plant({place.x(), place.y(), ground_z(place)}, size_m, tint);
      }
    });
    part_.solid = {ground, ground};
    part_.leaves = {plants, {}};
    mesh_.parts.push_back(part_);
  }

  /// Two crossing squares, darker at the foot.
  void add_plant(const Vector3d& foot, double size_m, const Vector3d& tint) {
    const double turn = uniform(0, std::numbers::pi);
    for (const double angle : {turn, turn + 0.5 * std::numbers::pi}) {
      const Vector3d x = 0.6 * size_m * Vector3d(std::cos(angle), std::sin(angle), 0), y(0, 0, 0.5 * size_m);
      add_card(foot + y, x, y, 0.6 * tint, tint, 3, 1, numbers_.undergrowth());
    }
  }

  const std::vector<Obstacle>& obstacles_;
  const std::vector<Tree>& trees_;
  Eigen::AlignedBox2d stand_;
  const WoodsConfig& config_;
  std::mt19937_64 generator_;
  std::uint32_t seed_;
  WoodsNumbers numbers_;
  WoodsMesh mesh_;
  WoodsPart part_;
};

}  // namespace

std::uint16_t WoodsNumbers::trunk(std::size_t tree) const {
  return static_cast<std::uint16_t>(object_first_obstacle + 3 * tree);
}

WoodsMesh woods_mesh(const std::vector<Obstacle>& obstacles, const std::vector<Tree>& trees,
                     const Eigen::AlignedBox2d& stand, const WoodsConfig& config, std::uint64_t seed) {
  return Builder(obstacles, trees, stand, config, seed).build();
}

}  // namespace understory
