#include "sim/scene/woods_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <span>

#include "sim/scene/mesh_builder.hpp"
#include "sim/scene/meshes.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

/// Colours of a kind: bark over its gray texture, fresh and dark leaves. Tints are over 128.
struct Colours {
  Vector3d bark, fresh, dark;
};
const std::array<Colours, 5> colours{{{{118, 108, 96}, {112, 146, 58}, {74, 96, 46}},     // oak
                                      {{140, 138, 130}, {124, 160, 66}, {82, 110, 50}},   // beech
                                      {{190, 188, 180}, {136, 164, 76}, {108, 122, 58}},  // birch
                                      {{138, 104, 78}, {92, 124, 70}, {60, 84, 54}},      // pine
                                      {{106, 94, 84}, {70, 104, 60}, {46, 70, 46}}}};     // spruce

bool is_conifer(TreeKind kind) { return kind == TreeKind::pine || kind == TreeKind::spruce; }

bool is_bare(TreeKind kind, const WoodsConfig& config) {
  return config.season == Season::winter && !is_conifer(kind);
}

/// Of leaves from fresh (0) to dark (1); of twigs where there are none.
Vector3d crown_tint(TreeKind kind, bool bare, const Vector3d& bark, double tone) {
  const Colours& own = colours[static_cast<std::size_t>(kind)];
  return bare ? Vector3d(0.9 * bark) : Vector3d(own.fresh + tone * (own.dark - own.fresh));
}

LeafPicture crown_picture(TreeKind kind, bool bare, int number) {
  if (bare) return LeafPicture::twigs;
  if (is_conifer(kind)) return LeafPicture::needles;
  return number % 2 == 0 ? LeafPicture::leaves : LeafPicture::more_leaves;
}

/// As many sides as keep a tube's surface within 1.2 mm of the round one: rays then agree within 2 mm.
int sides_of(double radius_m) {
  const int sides = static_cast<int>(std::ceil(std::numbers::pi * std::sqrt(radius_m / 0.0048)));
  return std::clamp(sides, 6, 41);
}

/// Draws one tree, near and far.
class TreePainter {
 public:
  TreePainter(MeshBuilder& builder, const std::vector<Obstacle>& obstacles, const Tree& tree,
              const WoodsConfig& config, const WoodsNumbers& numbers, std::size_t number)
      : builder_(builder),
        obstacles_(obstacles),
        tree_(tree),
        trunk_(static_cast<std::uint16_t>(numbers.trunk(number))),
        branch_(static_cast<std::uint16_t>(numbers.branch(number))),
        leaves_(static_cast<std::uint16_t>(numbers.leaves(number))),
        bare_(is_bare(tree.kind, config)) {
    const double tone = std::clamp(config.leaf_tone + uniform(-0.15, 0.15), 0.0, 1.0);
    bark_ = colours[static_cast<std::size_t>(tree.kind)].bark * uniform(0.85, 1.15);
    green_ = crown_tint(tree.kind, bare_, bark_, tone);
  }

  void paint() {
    builder_.begin_part(static_cast<WoodsTexture>(tree_.kind));
    read_stem();
    WoodsPart& part = builder_.part();
    const auto tubes = [&](int divided_by) {
      return builder_.range_of([&] {
        const auto sides = [&](double radius_m) { return std::max(5, sides_of(radius_m) / divided_by); };
        builder_.add_tube(axis_, radii_m_, sides(radii_m_[1]), bark_,
                          obstacles_[tree_.first].texture_turn_rad, trunk_);
        for (std::size_t i = first_branch(); i < first_branch() + tree_.branches; ++i)
          builder_.add_tube({obstacles_[i].from_world, obstacles_[i].to_world},
                            {obstacles_[i].radius_m, obstacles_[i].radius_m}, sides(obstacles_[i].radius_m),
                            0.85 * bark_, 0, branch_);
      });
    };
    part.solid[0] = tubes(1);
    part.coarse = tubes(2);
    part.solid[1] = builder_.range_of(
        [&] { builder_.add_ribbon(every_fourth(axis_), every_fourth(radii_m_), bark_, trunk_); });
    builder_.end_part();
    place_clumps();
    // Three storeys: what hangs above the view is not drawn.
    constexpr std::size_t storeys = 3;
    std::array<WoodsPart, storeys> crown;
    const auto clumps_of = [&](std::size_t storey) {
      const std::size_t from = storey * clumps_.size() / storeys,
                        to = (storey + 1) * clumps_.size() / storeys;
      return std::span(clumps_).subspan(from, to - from);
    };
    for (std::size_t i = 0; i < storeys; ++i)
      crown[i].leaves[0] = builder_.range_of([&] {
        for (const Clump& clump : clumps_of(i)) add_clump(clump);
        if (i + 1 == storeys) add_leaves_of_branches();
      });
    for (std::size_t i = 0; i < storeys; ++i)
      crown[i].leaves[1] = builder_.range_of([&] {
        for (const Clump& clump : clumps_of(i)) add_far_clump(clump);
      });
    std::vector<WoodsPart>& parts = builder_.mesh.parts;
    Eigen::AlignedBox3d whole_world = parts.back().box_world;
    for (WoodsPart& storey : crown) {
      storey.texture = static_cast<WoodsTexture>(tree_.kind);
      for (const WoodsRange& range : storey.leaves) storey.box_world.extend(builder_.box_of(range));
      whole_world.extend(storey.box_world);
    }
    parts.insert(parts.end(), crown.begin(), crown.end());
    for (std::size_t i = parts.size() - storeys - 1; i < parts.size(); ++i)
      parts[i].whole_world = whole_world;
  }

 private:
  /// Leaves that hang together: what one large branch of the crown carries.
  struct Clump {
    Vector3d middle, outward;
    double radius_m;
    double light;  ///< share of the light that reaches it
  };

  double uniform(double low, double high) { return builder_.uniform(low, high); }
  std::size_t first_branch() const { return tree_.first + tree_.trunk_pieces; }

  /// The drawn stem: every piece as thick as its obstacle from end to end, root flare, and on to the tree's
  /// top.
  void read_stem() {
    const Obstacle& lowest = obstacles_[tree_.first];
    const Vector3d up = (lowest.to_world - lowest.from_world).normalized();
    add_ring(lowest.from_world - 0.3 * up, 1.35 * lowest.radius_m);
    add_ring(lowest.from_world + 0.35 * up, lowest.radius_m);
    for (std::size_t i = 0; i < tree_.trunk_pieces; ++i) {
      const Obstacle& piece = obstacles_[tree_.first + i];
      if (i > 0) {  // where the thicker piece's round end meets this one
        const double before_m = obstacles_[tree_.first + i - 1].radius_m;
        const double beyond_m =
            std::sqrt(std::max(0.0, before_m * before_m - piece.radius_m * piece.radius_m));
        add_ring(piece.from_world + beyond_m * (piece.to_world - piece.from_world).normalized(),
                 piece.radius_m);
      }
      add_ring(piece.to_world, piece.radius_m);
    }
    const Vector3d direction = (axis_.back() - axis_[axis_.size() - 2]).normalized();
    const double left_m = tree_.height_m - axis_.back().z();
    add_ring(axis_.back() + direction * std::max(0.2, left_m), 0.02);
  }
  void add_ring(const Vector3d& middle, double radius_m) {
    axis_.push_back(middle);
    radii_m_.push_back(radius_m);
  }

  /// Of the rings, the ends too: what is enough from far away.
  template <typename Value>
  static std::vector<Value> every_fourth(const std::vector<Value>& values) {
    std::vector<Value> few;
    for (std::size_t i = 0; i < values.size(); i += 4) few.push_back(values[i]);
    if (values.size() % 4 != 1) few.push_back(values.back());
    return few;
  }

  Vector3d stem_at(double height_m) const {
    for (std::size_t i = 1; i < axis_.size(); ++i)
      if (axis_[i].z() >= height_m || i + 1 == axis_.size()) {
        const double share = (height_m - axis_[i - 1].z()) / (axis_[i].z() - axis_[i - 1].z());
        return axis_[i - 1] + share * (axis_[i] - axis_[i - 1]);
      }
    return axis_.back();
  }

  /// The crown's clumps: a cone's or an egg's, most of them outside, brighter above and towards the sun.
  void place_clumps() {
    const bool spruce = tree_.kind == TreeKind::spruce;
    const double base_m = tree_.kind == TreeKind::pine ? std::max(tree_.crown_base_m, 0.6 * tree_.height_m)
                                                       : tree_.crown_base_m;
    const double depth_m = std::max(tree_.height_m - base_m, 1.0);
    const int count = spruce ? 26 : 14;
    for (int i = 0; i < count; ++i) {
      // Evenly over the height and round the stem by the golden angle, so that no side is bare.
      const double share = (i + uniform(0, 1)) / count;
      const double turn = 2.39996 * i + uniform(-0.4, 0.4);
      const double hull =
          spruce ? 1 - 0.95 * share : std::sqrt(std::max(0.08, 1 - std::pow(1.6 * share - 0.6, 2)));
      const double out_m = (spruce ? 0.5 : uniform(0.35, 0.85)) * hull * tree_.crown_radius_m;
      const Vector3d outward(std::cos(turn), std::sin(turn), 0);
      const double sunny = 0.12 * outward.dot(builder_.mesh.to_sun_world) * hull;
      clumps_.push_back({stem_at(base_m + share * depth_m) + out_m * outward, outward,
                         spruce ? hull * tree_.crown_radius_m : 0.45 * tree_.crown_radius_m,
                         0.62 + 0.35 * share + sunny + uniform(-0.07, 0.07)});
    }
  }

  /// A square that faces `normal`, turned at random about it.
  Card leaves_at(const Vector3d& place, const Vector3d& normal, double size_m, int number) {
    const Vector3d side = normal.unitOrthogonal(), up = normal.cross(side);
    const double turn = uniform(0, 2 * std::numbers::pi);
    return {place, 0.5 * size_m * (std::cos(turn) * side + std::sin(turn) * up),
            0.5 * size_m * (std::cos(turn) * up - std::sin(turn) * side),
            crown_picture(tree_.kind, bare_, number)};
  }
  /// A branch's spray: from the stem outwards and down.
  Card spray_of(const Clump& clump, double width_m, double height_m) const {
    const Vector3d along = (clump.outward - Vector3d(0, 0, 0.35)).normalized();
    const Vector3d across = Vector3d::UnitZ().cross(clump.outward);
    return {clump.middle + Vector3d(0, 0, height_m), 0.5 * clump.radius_m * along, 0.5 * width_m * across,
            LeafPicture::needles};
  }

  void add_leaf_card(const Card& card, const Vector3d& low_tint, const Vector3d& high_tint) {
    builder_.add_card(card, low_tint, high_tint, leaves_);
    if (!bare_) builder_.mesh.leaf_cards.push_back({card.middle, card.x, card.y});
  }

  void add_clump(const Clump& clump) {
    if (tree_.kind == TreeKind::spruce) {
      for (const double side : {-0.5, 0.0, 0.5}) {
        Clump turned = clump;
        turned.outward = Eigen::AngleAxisd(side, Vector3d::UnitZ()) * clump.outward;
        turned.middle += 0.5 * clump.radius_m * (turned.outward - clump.outward);
        const Vector3d tint = clump.light * (1 - 0.2 * std::abs(side)) * green_;
        add_leaf_card(spray_of(turned, 0.6 * clump.radius_m + 0.3, 0.2 * side), 0.8 * tint, tint);
      }
      return;
    }
    for (int i = 0; i < 6; ++i) {
      Vector3d away(uniform(-1, 1), uniform(-1, 1), uniform(-0.8, 0.9));
      const Vector3d place = clump.middle + 0.8 * clump.radius_m * away;
      away.z() += is_conifer(tree_.kind) ? 1.2 : 0.5;
      const double light = clump.light + 0.14 * away.z();
      add_leaf_card(leaves_at(place, away.normalized(), clump.radius_m * uniform(0.8, 1.2) + 0.3, i),
                    0.9 * light * green_, light * green_);
    }
  }

  /// The same clump from far away: one or two large cards where the small ones are.
  void add_far_clump(const Clump& clump) {
    const Vector3d tint = (clump.light + 0.05) * green_;
    if (tree_.kind == TreeKind::spruce) {
      builder_.add_card(spray_of(clump, 1.4 * clump.radius_m, 0), 0.8 * tint, tint, leaves_);
      return;
    }
    const Vector3d normal =
        (clump.outward + Vector3d(uniform(-0.3, 0.3), uniform(-0.3, 0.3), 0.4)).normalized();
    builder_.add_card(leaves_at(clump.middle, normal, 2.2 * clump.radius_m, 0), 0.9 * tint, tint, leaves_);
  }

  void add_leaves_of_branches() {
    for (std::size_t i = first_branch(); i < first_branch() + tree_.branches; ++i) {
      const Obstacle& branch = obstacles_[i];
      if (branch.from_world.z() < tree_.crown_base_m - 0.01) continue;  // a dead stub
      for (int card = 0; card < 3; ++card) {
        const Vector3d place = branch.from_world + uniform(0.3, 1.05) * (branch.to_world - branch.from_world);
        const Vector3d normal = Vector3d(uniform(-0.6, 0.6), uniform(-0.6, 0.6), 1).normalized();
        add_leaf_card(leaves_at(place, normal, uniform(0.5, 0.9), card), 0.7 * green_, 0.75 * green_);
      }
    }
  }

  MeshBuilder& builder_;
  const std::vector<Obstacle>& obstacles_;
  const Tree& tree_;
  std::uint16_t trunk_, branch_, leaves_;
  bool bare_;
  Vector3d bark_, green_;
  std::vector<Vector3d> axis_;
  std::vector<double> radii_m_;
  std::vector<Clump> clumps_;
};

/// An obstacle of the scenario's own list, drawn as in plain scenery.
void add_listed(MeshBuilder& builder, const Obstacle& obstacle, std::size_t number) {
  const TrunkMesh mesh = listed_mesh(obstacle);
  builder.begin_part(obstacle.texture == ObstacleTexture::bark      ? WoodsTexture::oak
                     : obstacle.texture == ObstacleTexture::windows ? WoodsTexture::windows
                                                                    : WoodsTexture::ground);
  const Eigen::Isometry3d T_world_mesh = obstacle.T_world_box();
  const WoodsRange range = builder.range_of([&] {
    const auto first = static_cast<std::uint32_t>(builder.triangles.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
      builder.add_vertex(T_world_mesh * mesh.vertices[i], mesh.texture[i].x(), mesh.texture[i].y(),
                         builder.lit(Vector3d::Constant(128), T_world_mesh.linear() * mesh.normals[i]),
                         static_cast<std::uint16_t>(number));
    for (const Eigen::Vector3i& face : mesh.faces)
      for (const int corner : face)
        builder.triangles.indices.push_back(first + static_cast<std::uint32_t>(corner));
  });
  builder.part().solid = {range, range};
  builder.end_part();
}

}  // namespace

void add_far_tree(MeshBuilder& builder, const Tree& tree, double radius_m, const Eigen::Vector2d& place,
                  const WoodsConfig& config, std::uint16_t number) {
  const double lean = builder.uniform(-0.6, 0.6), turn = builder.uniform(0, 6);
  const Vector3d foot(place.x(), place.y(), builder.ground_z(place) - 0.1),
      top = foot + Vector3d(lean, -lean, tree.height_m);
  const Colours& own = colours[static_cast<std::size_t>(tree.kind)];
  const bool bare = is_bare(tree.kind, config);
  const Vector3d green = crown_tint(tree.kind, bare, own.bark, config.leaf_tone);
  const LeafPicture picture = crown_picture(tree.kind, bare, 0);
  builder.begin_part(static_cast<WoodsTexture>(tree.kind));
  const WoodsRange stem = builder.range_of([&] {
    builder.add_ribbon({foot, top}, {1.1 * radius_m, 0.02}, own.bark, number);
  });
  const WoodsRange crown = builder.range_of([&] {
    const double base = std::max(0.35, tree.crown_base_m / tree.height_m);
    for (int i = 0; i < 7; ++i) {
      const double share = (i + builder.uniform(0, 1)) / 7, angle = 2.4 * i + turn;
      const Vector3d outward(std::cos(angle), std::sin(angle), 0);
      const double hull = tree.kind == TreeKind::spruce ? 1 - 0.9 * share : 1 - 0.5 * share;
      const Vector3d middle =
          foot + (base + share * (1 - base)) * (top - foot) + 0.5 * hull * tree.crown_radius_m * outward;
      const double half_m = 0.8 * hull * tree.crown_radius_m + 0.4;
      const Vector3d across(-outward.y(), outward.x(), 0);
      const Vector3d tint = (0.6 + 0.4 * share) * green;
      builder.add_card({middle, half_m * across, half_m * (Vector3d(0, 0, 0.9) - 0.4 * outward), picture},
                       0.85 * tint, tint, number);
    }
  });
  builder.part().solid = {stem, stem};
  builder.part().leaves = {crown, crown};
  builder.end_part();
}

WoodsMesh woods_mesh(const std::vector<Obstacle>& obstacles, const std::vector<Tree>& trees,
                     const Eigen::AlignedBox2d& stand, const Eigen::AlignedBox2d& course,
                     const WoodsConfig& config, std::uint64_t seed) {
  const auto plan = std::make_shared<const WoodsPlan>(WoodsPlan{obstacles, trees, config});
  MeshBuilder builder(config, seed);
  builder.mesh.builder = [config, seed] { return MeshBuilder(config, seed); };
  const WoodsNumbers numbers{trees.size()};
  for (std::size_t i = 0; i < trees.size(); ++i)
    builder.add_piece([plan, numbers, i](MeshBuilder& to) {
      TreePainter(to, plan->obstacles, plan->trees[i], plan->config, numbers, i).paint();
    });
  std::size_t alone = 0;
  for (const Obstacle& obstacle : plan->obstacles)
    if (obstacle.tree < 0)
      builder.add_piece([plan, &obstacle, number = numbers.alone(alone++)](MeshBuilder& to) {
        add_listed(to, obstacle, number);
      });
  builder.mesh.obstacle_parts = builder.mesh.parts.size();
  add_forest_floor(builder, plan, stand, course);
  return std::move(builder.mesh);
}

void visit_triangles(const WoodsMesh& mesh, std::span<const std::uint32_t> pieces,
                     const std::function<void(std::uint32_t piece, const WoodsTriangles&)>& use) {
  std::optional<MeshBuilder> builder;
  for (const std::uint32_t number : pieces) {
    const WoodsPiece& piece = mesh.pieces[number];
    if (!piece.triangles.indices.empty()) {
      use(number, piece.triangles);
      continue;
    }
    if (!builder) builder.emplace(mesh.builder());
    use(number, builder->grown_again(piece));
  }
}

void paint(WoodsMesh& mesh) {
  for (std::size_t i = 0; i < woods_texture_count; ++i) {
    const auto which = static_cast<WoodsTexture>(i);
    const auto uses = [&](const WoodsPart& part) { return part.texture == which; };
    const bool used = which == WoodsTexture::leaves || std::ranges::any_of(mesh.parts, uses);
    if (used && mesh.textures[i].rgba.empty())
      mesh.textures[i] = woods_picture(which, mesh.seed, mesh.overcast);
  }
}

}  // namespace understory
