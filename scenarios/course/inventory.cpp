#include "scenarios/course/inventory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>

#include "perception/io/text_file.hpp"
#include "perception/io/text_table.hpp"
#include "scenarios/config/named_seed.hpp"
#include "scenarios/output/errors.hpp"

namespace understory {
namespace {

using Eigen::Vector2d;

constexpr std::size_t most_stems = 2'000'000;
constexpr std::size_t largest_file_bytes = std::size_t{256} << 20;

enum StemColumn : std::size_t { x_m, y_m, diameter_m, height_m, lean_rad, lean_toward_rad, kind };
constexpr std::array columns{Column{"x_m"},
                             Column{"y_m"},
                             Column{"diameter_m"},
                             Column{"height_m", "", true},
                             Column{"lean_rad", "", true},
                             Column{"lean_toward_rad", "", true},
                             Column{"kind", "", true}};

double number_at(const TableLine& line, StemColumn column, double least, double most,
                 const std::string& name) {
  const auto value = number_in(line.cells[column]);
  if (!value || *value < least || *value > most)
    fail_at_line(name, line.number,
                 fmt::format("{}: expected a number from {} to {}, got '{}'", columns[column].names, least,
                             most, line.cells[column]));
  return *value;
}

std::optional<TreeKind> kind_in(std::string_view word, const std::string& name, int line) {
  if (word.empty()) return std::nullopt;
  for (std::size_t i = 0; i < tree_kind_names.size(); ++i)
    if (tree_kind_names[i] == word) return static_cast<TreeKind>(i);
  fail_at_line(name, line, fmt::format("kind: expected oak, beech, birch, pine or spruce, got '{}'", word));
}

/// Of the course: from where the forest begins to the goal, corners in the launch frame.
std::array<Vector2d, 4> corners_of(const ForestConfig& config) {
  const double goal_m = config.clear_m + config.length_m, half_m = config.half_width_m;
  return {Vector2d(config.clear_m, -half_m), Vector2d(goal_m, -half_m), Vector2d(goal_m, half_m),
          Vector2d(config.clear_m, half_m)};
}

}  // namespace

std::vector<Stem> stems_in_text(std::string_view text, const std::string& name) {
  const NamedTable table = named_table(text, CellsParted::by_commas, name, columns);
  if (table.names.empty())
    fail_at_line(name, 1, "expected a first line with the names of the columns: x_m, y_m, diameter_m");
  if (table.names[lean_rad].empty() != table.names[lean_toward_rad].empty())
    fail_at_line(name, 1, "expected both lean_rad and lean_toward_rad, or neither");
  if (table.lines.empty()) fail_at_line(name, 1, "expected at least one stem below this line");
  if (table.lines.size() > most_stems)
    fail_at_line(name, table.lines.back().number, fmt::format("expected at most {} stems", most_stems));
  std::vector<Stem> stems;
  stems.reserve(table.lines.size());
  for (const TableLine& line : table.lines) {
    const auto number = [&](StemColumn column, double least, double most) {
      return number_at(line, column, least, most, name);
    };
    Stem stem{{number(x_m, -1e7, 1e7), number(y_m, -1e7, 1e7)}, number(diameter_m, 0.001, 10), {}};
    if (!line.cells[height_m].empty()) stem.known.height_m = number(height_m, 1, 150);
    if (!line.cells[lean_rad].empty()) {
      const double lean = std::tan(number(lean_rad, 0, 1)),
                   toward_rad = line.cells[lean_toward_rad].empty() ? 0 : number(lean_toward_rad, -6.3, 6.3);
      stem.known.lean = lean * Vector2d(std::cos(toward_rad), std::sin(toward_rad));
    }
    stem.known.kind = kind_in(line.cells[kind], name, line.number);
    stems.push_back(stem);
  }
  return stems;
}

std::vector<Stem> stems_of(const ForestConfig& config) {
  std::error_code ignored;
  if (!std::filesystem::exists(config.trees_file, ignored))
    throw ScenarioError(
        fmt::format("{}: not found beside the scenario, nor in the folder that the environment "
                    "variable UNDERSTORY_DATA names (docs/woods.md says where to get it)",
                    config.trees_file));
  std::vector<Stem> stems =
      stems_in_text(read_file(config.trees_file, largest_file_bytes), config.trees_file);
  std::erase_if(stems, [&](const Stem& stem) { return stem.diameter_m < config.thinnest_stem_m; });
  if (stems.empty())
    throw ScenarioError(fmt::format("{}: forest.thinnest_stem_m: the file has no stem of {} m or more",
                                    config.trees_file, config.thinnest_stem_m));
  return stems;
}

PlacedStems place_stems(const std::vector<Stem>& stems, const ForestConfig& config, std::uint64_t seed) {
  Eigen::AlignedBox2d plot;
  for (const Stem& stem : stems) plot.extend(stem.place_m);
  std::mt19937_64 generator(seed_for(seed, "inventory"));
  std::uniform_real_distribution<double> unit(0, 1);
  PlacedStems placed;
  const auto fits = [&] {
    return std::ranges::all_of(corners_of(config), [&](const Vector2d& corner) {
      return plot.contains(placed.launch_m + Eigen::Rotation2Dd(placed.heading_rad) * corner);
    });
  };
  bool found = false;
  for (int tries = 0; tries < 100'000 && !found; ++tries) {
    const double x = unit(generator), y = unit(generator), turn = unit(generator);
    // The course's middle is drawn, not the launch: it may well lie outside.
    placed.heading_rad = config.file_heading_rad.value_or(2 * std::numbers::pi * turn);
    const Vector2d middle = plot.min() + plot.sizes().cwiseProduct(Vector2d(x, y));
    const Vector2d launch =
        middle - Eigen::Rotation2Dd(placed.heading_rad) * Vector2d(config.clear_m + 0.5 * config.length_m, 0);
    placed.launch_m = {config.file_x_m.value_or(launch.x()), config.file_y_m.value_or(launch.y())};
    found = fits();
  }
  if (!found)
    throw ScenarioError(fmt::format(
        "{}: the course ({} m by {} m, forest.length_m and half_width_m) does not "
        "fit between the stems, which cover {:.0f} m by {:.0f} m{}",
        config.trees_file, config.length_m, 2 * config.half_width_m, plot.sizes().x(), plot.sizes().y(),
        config.file_x_m || config.file_y_m || config.file_heading_rad
            ? ", from where forest.file_x_m, file_y_m and file_heading_rad put it"
            : ""));
  const auto back = Eigen::Rotation2Dd(-placed.heading_rad);
  std::vector<std::pair<Vector2d, const Stem*>> standing;
  for (const Stem& stem : stems) {
    const Vector2d place = back * (stem.place_m - placed.launch_m);
    const bool inside = place.x() >= config.clear_m && place.x() <= config.clear_m + config.length_m &&
                        std::abs(place.y()) <= config.half_width_m;
    if (inside) standing.emplace_back(place, &stem);
  }
  if (standing.empty())
    throw ScenarioError(fmt::format(
        "{}: no stem stands on the course that begins at ({:.1f}, {:.1f}) with a heading of {:.3f} rad",
        config.trees_file, placed.launch_m.x(), placed.launch_m.y(), placed.heading_rad));
  std::ranges::stable_sort(standing, {}, [](const auto& stem) { return stem.first.x(); });
  for (const auto& [place, stem] : standing) {
    Obstacle trunk;
    trunk.name = fmt::format("tree_{:04}", placed.obstacles.size());
    KnownTree known = stem->known;
    if (known.lean) known.lean = back * *known.lean;
    const double top_m = config.trunk_height_m;
    trunk.from_world = {place.x(), place.y(), 0};
    trunk.to_world = trunk.from_world + Eigen::Vector3d(0, 0, top_m);
    if (known.lean) trunk.to_world.head<2>() += top_m * *known.lean;
    trunk.radius_m = 0.5 * stem->diameter_m;
    trunk.texture_turn_rad = 2 * std::numbers::pi * unit(generator);
    trunk.texture_shift = unit(generator);
    placed.obstacles.push_back(trunk);
    placed.known.push_back(known);
  }
  return placed;
}

void draw_inventory_stems(const ForestConfig& config, std::uint64_t seed, std::vector<Obstacle>& trees) {
  // Diameter beyond 3 cm: with this share exponential, else Weibull. Kolmogorov-Smirnov distance to the
  // plot's diameters 0.012.
  constexpr double from_m = 0.03, thin_share = 0.721, thin_mean_m = 0.0592, thick_shape = 1.938,
                   thick_scale_m = 0.409;
  constexpr double thin_below_m = 0.10;
  // Ripley's K of the stems from 3 to 10 cm: an excess that saturates beyond 14 m (for all stems that of 80
  // m^2 fits windows of a flight), and one of 5.9 m^2 within half a metre, as where an eighth of the stems
  // has a twin.
  constexpr double area_per_cluster_m2 = 80, cluster_sigma_m = 7, twin_share = 0.10, twin_sigma_m = 0.2;
  std::mt19937_64 generator(seed_for(seed, "inventory_stems"));
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  const Eigen::AlignedBox2d stand(Vector2d(config.clear_m, -config.half_width_m),
                                  Vector2d(config.clear_m + config.length_m, config.half_width_m));
  const auto within = [&](const Eigen::AlignedBox2d& box) -> Vector2d {
    return box.min() + box.sizes().cwiseProduct(Vector2d(unit(generator), unit(generator)));
  };
  const Eigen::AlignedBox2d around(stand.min() - Vector2d::Constant(2 * cluster_sigma_m),
                                   stand.max() + Vector2d::Constant(2 * cluster_sigma_m));
  std::poisson_distribution<int> clusters(around.volume() / area_per_cluster_m2);
  std::vector<Vector2d> centres(static_cast<std::size_t>(std::max(1, clusters(generator))));
  for (Vector2d& centre : centres) centre = within(around);
  std::optional<Vector2d> twin_of;
  for (Obstacle& tree : trees) {
    double diameter_m = 0;
    for (int tries = 0; tries < 100'000; ++tries) {
      const bool thin = unit(generator) < thin_share;
      const double rest = -std::log(1 - unit(generator));
      diameter_m = from_m + (thin ? thin_mean_m * rest : thick_scale_m * std::pow(rest, 1 / thick_shape));
      if (diameter_m >= 2 * config.radius_min_m && diameter_m <= 2 * config.radius_max_m) break;
    }
    tree.radius_m = std::clamp(0.5 * diameter_m, config.radius_min_m, config.radius_max_m);
    Vector2d place = within(stand);
    if (2 * tree.radius_m < thin_below_m) {
      const bool twin = twin_of && unit(generator) < twin_share;
      const double sigma_m = twin ? twin_sigma_m : cluster_sigma_m;
      for (int tries = 0; tries < 1000; ++tries) {
        const Vector2d middle = twin ? *twin_of : centres[generator() % centres.size()];
        const Vector2d there = middle + sigma_m * Vector2d(normal(generator), normal(generator));
        if (!stand.contains(there)) continue;
        place = there;
        break;
      }
      twin_of = place;
    }
    tree.to_world.head<2>() += place - tree.from_world.head<2>();
    tree.from_world.head<2>() = place;
  }
}

}  // namespace understory
