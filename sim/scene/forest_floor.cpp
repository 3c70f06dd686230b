#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "sim/scene/mesh_builder.hpp"

namespace understory {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double cell_m = 2.5;
constexpr int cells_per_patch = 4;
constexpr double patch_m = cells_per_patch * cell_m;
constexpr double far_reach_m = 45;  ///< how far the wood goes on beyond the stand
constexpr double far_lean_m = 1;    ///< most by which a far stem reaches sideways from its foot
constexpr double thicket_half_m = 3.5;
const Vector3d green(98, 126, 58);

/// One patch of ground: its relief, and ferns, shrubs and grass, each where it likes to grow.
class FloorPainter {
 public:
  FloorPainter(MeshBuilder& builder, const WoodsConfig& config, const WoodsNumbers& numbers)
      : builder_(builder),
        config_(config),
        plants_(static_cast<std::uint16_t>(numbers.undergrowth())),
        log_(static_cast<std::uint16_t>(numbers.log())) {}

  void paint(const Vector2d& corner) {
    std::vector<Plant> plants;
    const int count = static_cast<int>(config_.undergrowth * patch_m * patch_m * 0.9);
    for (int i = 0; i < count; ++i) plant_one(corner, plants);
    for (const std::size_t row : {0, 2})
      for (const std::size_t column : {0, 2}) paint_quarter(corner, row, column, plants);
    const double logs = config_.fallen_logs * patch_m * patch_m / 10'000;
    if (builder_.uniform(0, 1) < logs) add_log(corner + patch_m * random_place());
  }

 private:
  enum class PlantKind { fern, shrub, grass };
  struct Plant {
    PlantKind kind;
    Vector3d foot;
    double size_m, turn_rad;
    Vector3d tint;
  };

  Vector2d random_place() {
    const double x = builder_.uniform(0, 1);
    return {x, builder_.uniform(0, 1)};
  }

  /// Quarters are small enough that plants outside of the view, and beyond the near ones, are left out.
  void paint_quarter(const Vector2d& corner, std::size_t row, std::size_t column,
                     const std::vector<Plant>& plants) {
    builder_.begin_part(WoodsTexture::ground);
    WoodsPart& part = builder_.part();
    add_ground(corner, row, column, part);
    const Vector2d low = corner + cell_m * Vector2d(static_cast<double>(column), static_cast<double>(row));
    const auto add_plants = [&](bool near) {
      return builder_.range_of([&] {
        for (const Plant& plant : plants)
          if (((plant.foot.head<2>() - low) / (2 * cell_m)).array().floor().isZero()) add_plant(plant, near);
      });
    };
    part.leaves[0] = add_plants(true);
    part.leaves[1] = add_plants(false);
    builder_.end_part();
  }

  /// Far away every second row and column is enough. On a quarter's rim the corners between lie on the
  /// straight line, so that no gap opens beside a patch that is drawn the other way.
  void add_ground(const Vector2d& corner, std::size_t first_row, std::size_t first_column, WoodsPart& part) {
    const Vector3d leaves_on_soil(124, 100, 72), moss(92, 108, 66);
    std::array<std::array<std::uint32_t, 3>, 3> at{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t row = first_row + i, column = first_column + j;
        const Vector2d place =
            corner + cell_m * Vector2d(static_cast<double>(column), static_cast<double>(row));
        const auto slope = [&](const Vector2d& step) {
          return builder_.ground_z(place - step) - builder_.ground_z(place + step);
        };
        const Vector3d normal = Vector3d(slope({0.5, 0}), slope({0, 0.5}), 1).normalized();
        const double brown =
            std::clamp(config_.litter + 0.35 * noise_at(place / 5, builder_.noise_seed + 7), 0.0, 1.0);
        at[i][j] =
            builder_.add_vertex({place.x(), place.y(), height(corner, row, column)},
                                place.x() / dapple_tile_m, place.y() / dapple_tile_m,
                                builder_.lit(moss + brown * (leaves_on_soil - moss), normal), object_ground);
      }
    for (const std::size_t step : {1, 2})
      part.solid[step - 1] = builder_.range_of([&] {
        for (std::size_t i = 0; i < 2; i += step)
          for (std::size_t j = 0; j < 2; j += step)
            builder_.add_quad(at[i][j], at[i][j + step], at[i + step][j + step], at[i + step][j]);
      });
  }

  double height(const Vector2d& corner, std::size_t row, std::size_t column) const {
    const auto z = [&](std::size_t r, std::size_t c) {
      return builder_.ground_z(corner + cell_m * Vector2d(static_cast<double>(c), static_cast<double>(r)));
    };
    if (row % 2 == 0 && column % 2 == 1) return 0.5 * (z(row, column - 1) + z(row, column + 1));
    if (column % 2 == 0 && row % 2 == 1) return 0.5 * (z(row - 1, column) + z(row + 1, column));
    return z(row, column);
  }

  void plant_one(const Vector2d& corner, std::vector<Plant>& plants) {
    const Vector2d place = corner + patch_m * random_place();
    const double wet = 0.5 + 0.5 * noise_at(place / 6, builder_.noise_seed + 3),
                 open = 0.5 + 0.5 * noise_at(place / 9, builder_.noise_seed + 4);
    const double chance = builder_.uniform(0, 1), size = builder_.uniform(0, 1),
                 turn = builder_.uniform(0, 3);
    const double bright = builder_.uniform(0.75, 1.1);
    Plant plant{PlantKind::grass,
                {place.x(), place.y(), builder_.ground_z(place)},
                0.25 + 0.25 * size,
                turn,
                bright * green};
    if (chance < 0.75 * wet * wet) {
      plant.kind = PlantKind::fern;
      plant.size_m = 0.4 + 0.5 * size * wet;
    } else if (chance > 1 - 0.12 * open) {
      plant.kind = PlantKind::shrub;
      plant.size_m = 0.5 + 0.6 * size;
      plant.tint *= 0.85;
    } else if (builder_.uniform(0, 1) > open) {
      return;
    }
    if (config_.season == Season::winter) plant.tint = bright * Vector3d(122, 104, 66);
    plants.push_back(plant);
  }

  void add_plant(const Plant& plant, bool near) {
    switch (plant.kind) {
      case PlantKind::fern:
        return near ? add_rosette(plant) : add_crossed(plant, LeafPicture::fern, 0.7, near);
      case PlantKind::shrub:
        return add_crossed(plant, LeafPicture::thicket, 1.0, near);
      case PlantKind::grass:
        if (near) add_crossed(plant, LeafPicture::grass, 0.6, near);
    }
  }

  /// Fronds that arch outwards, as one sees them from above.
  void add_rosette(const Plant& plant) {
    for (int i = 0; i < 6; ++i) {
      const double turn = plant.turn_rad + i * std::numbers::pi / 3;
      const Vector3d outward(std::cos(turn), std::sin(turn), 0), across(-outward.y(), outward.x(), 0);
      const Vector3d along = 0.5 * plant.size_m * (0.85 * outward + Vector3d(0, 0, 0.55));
      builder_.add_card({plant.foot + along, 0.32 * plant.size_m * across, along, LeafPicture::frond},
                        0.7 * plant.tint, plant.tint, plants_);
    }
  }
  /// Upright squares that cross, darker at the foot; one, seen from far away.
  void add_crossed(const Plant& plant, LeafPicture picture, double half_width, bool near) {
    for (int i = 0; i < (near ? 2 : 1); ++i) {
      const double turn = plant.turn_rad + 0.5 * std::numbers::pi * i;
      const Vector3d x = half_width * plant.size_m * Vector3d(std::cos(turn), std::sin(turn), 0),
                     y(0, 0, 0.5 * plant.size_m);
      builder_.add_card({plant.foot + 0.95 * y, x, y, picture}, 0.65 * plant.tint, plant.tint, plants_);
    }
  }

  /// Half sunk into the litter.
  void add_log(const Vector2d& place) {
    const double length_m = builder_.uniform(2.5, 8), turn = builder_.uniform(0, 2 * std::numbers::pi),
                 radius_m = builder_.uniform(0.08, 0.22);
    const Vector2d end = place + length_m * Vector2d(std::cos(turn), std::sin(turn));
    const auto on_ground = [&](const Vector2d& at) {
      return Vector3d(at.x(), at.y(), builder_.ground_z(at) + 0.5 * radius_m);
    };
    const int any = static_cast<int>(builder_.uniform(0, 4.999));  // drawn in any case
    const bool mixed = config_.kinds == WoodsKinds::mixed;
    builder_.begin_part(static_cast<WoodsTexture>(
        mixed ? any : static_cast<int>(config_.kinds) - static_cast<int>(WoodsKinds::oak)));
    const WoodsRange log = builder_.range_of([&] {
      builder_.add_tube({on_ground(place), on_ground(0.5 * (place + end)), on_ground(end)},
                        {radius_m, 0.9 * radius_m, 0.7 * radius_m}, 8, Vector3d(96, 96, 78), turn, log_);
    });
    builder_.part().solid = {log, log};
    builder_.end_part();
  }

  MeshBuilder& builder_;
  const WoodsConfig& config_;
  std::uint16_t plants_, log_;
};

void add_thicket(MeshBuilder& builder, const Vector2d& place, const Vector3d& tint, std::uint16_t number) {
  const double half_m = builder.uniform(2, thicket_half_m), height_m = builder.uniform(2.5, 4.5),
               turn = builder.uniform(0, std::numbers::pi);
  builder.begin_part(WoodsTexture::ground);
  const WoodsRange range = builder.range_of([&] {
    const Vector3d y(0, 0, 0.5 * height_m);
    builder.add_card({Vector3d(place.x(), place.y(), builder.ground_z(place) - 0.2) + y,
                      half_m * Vector3d(std::cos(turn), std::sin(turn), 0), y, LeafPicture::thicket},
                     0.6 * tint, 0.85 * tint, number);
  });
  builder.part().leaves = {range, range};
  builder.end_part();
}

}  // namespace

void add_forest_floor(MeshBuilder& builder, const std::shared_ptr<const WoodsPlan>& plan,
                      const Eigen::AlignedBox2d& stand, const Eigen::AlignedBox2d& course) {
  const std::vector<Tree>& trees = plan->trees;
  const WoodsNumbers numbers{trees.size()};
  const Vector2d low = (stand.min() - Vector2d::Constant(far_reach_m + 25)) / patch_m,
                 high = (stand.max() + Vector2d::Constant(far_reach_m + 25)) / patch_m;
  for (int row = static_cast<int>(std::floor(low.y())); row < high.y(); ++row)
    for (int column = static_cast<int>(std::floor(low.x())); column < high.x(); ++column)
      builder.add_piece([plan, numbers, row, column](MeshBuilder& to) {
        FloorPainter(to, plan->config, numbers).paint(Vector2d(column, row) * patch_m);
      });
  if (trees.empty()) return;
  const auto number = static_cast<std::uint16_t>(numbers.far_wood());
  const Eigen::AlignedBox2d reach(stand.min() - Vector2d::Constant(far_reach_m),
                                  stand.max() + Vector2d::Constant(far_reach_m));
  // Free of far trees: the stand, the place behind it from which the aircraft starts, and the goal's.
  const Eigen::AlignedBox2d around(stand.min() - Vector2d(18, 1), stand.max() + Vector2d(4, 1));
  const double density = std::clamp(static_cast<double>(trees.size()) / stand.volume(), 0.01, 0.04);
  const int count = static_cast<int>(0.7 * density * reach.volume());
  const Vector3d tint = plan->config.season == Season::winter ? Vector3d(112, 100, 80) : green;
  for (int i = 0; i < count; ++i) {
    const double x = builder.uniform(reach.min().x(), reach.max().x());
    const Vector2d place(x, builder.uniform(reach.min().y(), reach.max().y()));
    const auto pick = static_cast<std::size_t>(builder.uniform(0, 0.999) * static_cast<double>(trees.size()));
    // The clearing of the launch stays free.
    if (around.contains(place) || (place.x() < stand.min().x() && std::abs(place.y()) < 8)) continue;
    const double beside_m = course.isEmpty() ? far_reach_m : course.exteriorDistance(place);
    // Thickets close the view under the crowns, where there would be a horizon.
    const bool has_thicket = around.exteriorDistance(place) > 4;
    builder.add_piece([=](MeshBuilder& to) {
      const Tree& tree = plan->trees[pick];
      add_far_tree(to, tree, plan->obstacles[tree.first].radius_m, place, plan->config, number);
      if (beside_m < far_lean_m) to.mesh.parts.pop_back();
      if (!has_thicket) return;
      add_thicket(to, place, tint, number);
      if (beside_m < thicket_half_m) to.mesh.parts.pop_back();
    });
  }
}

}  // namespace understory
