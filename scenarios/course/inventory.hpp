#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/course/courses.hpp"
#include "sim/scene/trees.hpp"

namespace understory {

/// A measured stem. Place in the file's own coordinates (m), diameter at 1.3 m height.
struct Stem {
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  double diameter_m = 0;
  KnownTree known;  ///< what else the file states; a lean's direction in the file's coordinates
};

/// Stems of a CSV table. Its first line names the columns: x_m, y_m and diameter_m are needed; height_m,
/// lean_rad with lean_toward_rad (the direction of the top, counter-clockwise from x), and kind (oak, beech,
/// birch, pine, spruce) are read if present, and their cells may be empty; other columns are ignored. Throws
/// InputError "name:line: ..." at the first invalid cell.
std::vector<Stem> stems_in_text(std::string_view text, const std::string& name);

/// The stems of `config.trees_file` that are at least config.thinnest_stem_m thick. Throws ScenarioError in
/// one line where the file cannot be found or read.
std::vector<Stem> stems_of(const ForestConfig& config);

/// The stems that stand on the course, in the launch frame: upright if the file states no lean. Trunks are as
/// high as config.trunk_height_m and ordered by x; leans are in the launch frame.
struct PlacedStems : Planted {
  Eigen::Vector2d launch_m{0, 0};  ///< in the file's coordinates
  double heading_rad = 0;
};

/// If the launch's place or heading are not given, the seed draws them so that the course's rectangle lies
/// within that of all stems. Throws ScenarioError where no such place is found.
PlacedStems place_stems(const std::vector<Stem>& stems, const ForestConfig& config, std::uint64_t seed);

/// Radii and places of a random forest after a measured one (forest.stems inventory). Diameters: a mixture
/// fitted to the 18,909 stems of at least 3 cm of the SCBI plot (Bourg et al. 2013, Ecology 94, 2111); stems
/// below 10 cm stand in clusters of a Neyman-Scott process fitted to Ripley's K of that plot's, thicker ones
/// independently (docs/woods.md).
void draw_inventory_stems(const ForestConfig& config, std::uint64_t seed, std::vector<Obstacle>& trees);

}  // namespace understory
