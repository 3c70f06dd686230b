#include "scenarios/course/stand_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scenarios/course/inventory.hpp"
#include "scenarios/output/errors.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/text.hpp"

namespace understory {
namespace {

using Eigen::Vector2d;

Eigen::AlignedBox2d square(double side_m) { return {Vector2d::Zero(), Vector2d::Constant(side_m)}; }

Stand independent(std::uint64_t seed, int count = 120, double side_m = 60) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> place(0, side_m), diameter(0.1, 0.5);
  Stand stand{square(side_m), {}, {}};
  for (int i = 0; i < count; ++i) {
    const double x = place(generator);
    stand.places.emplace_back(x, place(generator));
    stand.diameters_m.push_back(diameter(generator));
  }
  return stand;
}

/// Thomas process: K(r) = pi r^2 + (1 - exp(-r^2 / 4 sigma^2)) / kappa.
Stand clustered(std::uint64_t seed, double kappa, double sigma_m, double side_m = 100) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> place(-20, side_m + 20);
  std::normal_distribution<double> offset(0, sigma_m);
  Stand stand{square(side_m), {}, {}};
  const int parents = std::poisson_distribution<int>(kappa * (side_m + 40) * (side_m + 40))(generator);
  for (int parent = 0; parent < parents; ++parent) {
    const double x = place(generator), y = place(generator);
    const int children = std::poisson_distribution<int>(8)(generator);
    for (int child = 0; child < children; ++child) {
      const double dx = offset(generator);
      const Vector2d there(x + dx, y + offset(generator));
      if (!stand.window.contains(there)) continue;
      stand.places.push_back(there);
      stand.diameters_m.push_back(0.1);
    }
  }
  return stand;
}

TEST(StandStatistics, IndependentPlacesHaveNoStructure) {
  std::vector<Stand> stands;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) stands.push_back(independent(seed));
  const StandFigures figures = figures_of(stands);
  EXPECT_NEAR(figures.clark_evans, 1, 0.02);
  for (const double value : figures.l_minus_r) EXPECT_NEAR(value, 0, 0.12);
  EXPECT_NEAR(figures.stems_per_ha, 120 / 0.36, 1e-9);
  EXPECT_NEAR(figures.basal_area_m2_per_ha,
              333.3 * 0.25 * 3.1416 * (0.5 * 0.5 * 0.5 - 0.1 * 0.1 * 0.1) / 3 / 0.4, 0.6);
}

TEST(StandStatistics, ClustersHaveTheKOfTheirProcess) {
  constexpr double kappa = 0.005, sigma_m = 2;
  std::vector<double> sum(std::size(ripley_radii_m), 0);
  constexpr int count = 60;
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    const std::vector<double> l = ripley_l_minus_r(clustered(seed, kappa, sigma_m));
    for (std::size_t i = 0; i < l.size(); ++i) sum[i] += l[i] / count;
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double r = ripley_radii_m[i];
    const double k = M_PI * r * r + (1 - std::exp(-r * r / (4 * sigma_m * sigma_m))) / kappa;
    EXPECT_NEAR(sum[i], std::sqrt(k / M_PI) - r, 0.2) << r;
  }
}

TEST(StandStatistics, ASquareLatticeIsTwiceAsRegularAsChance) {
  Stand lattice{square(100), {}, {}};
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) lattice.places.emplace_back(2.5 + 5 * x, 2.5 + 5 * y);
  EXPECT_NEAR(clark_evans_index(lattice), 2, 0.1);
}

TEST(StandStatistics, TestsTellForestsApartAndLeaveEqualOnesAlone) {
  std::vector<Stand> one, same, bunched;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    one.push_back(independent(seed));
    same.push_back(independent(seed + 100));
    bunched.push_back(clustered(seed, 0.005, 2));
  }
  const StandTests equal = compare(one, same), different = compare(one, bunched);
  EXPECT_GT(equal.ks_p, 0.01);
  EXPECT_GT(equal.k_p, 0.01);
  EXPECT_LT(different.ks_p, 1e-6);
  EXPECT_LE(different.k_p, 0.002);
}

constexpr const char* table = "x_m,y_m,diameter_m,species,height_m,lean_rad,lean_toward_rad,kind\n";

TEST(Inventory, ReadsWhatRWrites) {
  const std::vector<Stem> quoted = stems_in_text(
      "\"x_m\",\"y_m\",\"diameter_m\",\"note\"\n1,2,.3,\"Genus species, L.\"\n3,4,0.2,\"a \"\"b\"\",\nc\"\n",
      "stems.csv");
  ASSERT_EQ(quoted.size(), 2u);
  EXPECT_EQ(quoted[1].place_m, Vector2d(3, 4));
  const std::string unclosed =
      support::refusal_of([] { stems_in_text("x_m,y_m,diameter_m\n1,2,\"0.3\n", "stems.csv"); });
  EXPECT_EQ(unclosed.find("stems.csv:2: quotation marks"), 0u) << unclosed;
}

// A height in centimetres would be passed over.
TEST(Inventory, ColumnsThatAreNearlyOursAreRefused) {
  for (const char* column : {"height_cm", "lean_deg", "kinds"}) {
    const std::string said = support::refusal_of(
        [&] { stems_in_text(std::string("x_m,y_m,diameter_m,") + column + "\n1,2,0.3,4\n", "stems.csv"); });
    EXPECT_EQ(said.find(std::string("stems.csv:1: ") + column + ": not a column that is read"), 0u) << said;
  }
}

TEST(Inventory, ReadsWhatTheColumnsSay) {
  const std::vector<Stem> stems =
      stems_in_text(std::string(table) + "1,2,0.2,quru,17,0.1,0,oak\n3.5,-4,0.05,,,,,\n", "stems.csv");
  ASSERT_EQ(stems.size(), 2u);
  EXPECT_EQ(stems[0].place_m, Vector2d(1, 2));
  EXPECT_EQ(stems[0].known.height_m, 17);
  EXPECT_EQ(stems[0].known.kind, TreeKind::oak);
  EXPECT_NEAR(stems[0].known.lean->x(), std::tan(0.1), 1e-12);
  EXPECT_EQ(stems[1].known.height_m, 0);
  EXPECT_FALSE(stems[1].known.lean || stems[1].known.kind);
}

TEST(Inventory, CoursesKeepTheDistancesBetweenStems) {
  std::vector<Stem> stems;
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> place(0, 300);
  for (int i = 0; i < 9000; ++i) {
    const double x = place(generator);
    stems.push_back({{x, place(generator)}, 0.3, {}});
  }
  stems[0].known.lean = Vector2d(0.1, 0);
  const ForestConfig config;
  for (std::uint64_t seed = 1000; seed < 1020; ++seed) {
    const PlacedStems placed = place_stems(stems, config, seed);
    const double area = config.length_m * 2 * config.half_width_m;
    EXPECT_NEAR(static_cast<double>(placed.obstacles.size()), 0.1 * area, 5 * std::sqrt(0.1 * area));
    const Eigen::Rotation2Dd turn(placed.heading_rad);
    for (const Obstacle& trunk : placed.obstacles) {
      EXPECT_GE(trunk.from_world.x(), config.clear_m);
      const Vector2d there = placed.launch_m + turn * trunk.from_world.head<2>();
      EXPECT_TRUE(
          std::ranges::any_of(stems, [&](const Stem& stem) { return (stem.place_m - there).norm() < 1e-9; }));
    }
  }
  ForestConfig given;
  given.file_x_m = 20, given.file_y_m = 150, given.file_heading_rad = 0;
  const PlacedStems placed = place_stems(stems, given, 7);
  EXPECT_EQ(placed.launch_m, Vector2d(20, 150));
}

/// The measured plot is not in the repository: where it is there, the drawn forests are like it.
TEST(Inventory, DrawnForestsAreLikeTheMeasuredOne) {
  const std::string name = "scbi-2008.csv";
  auto file = support::shared_data(name);
  if (!file) file = support::shared_data("forests/" + name);
  if (!file) GTEST_SKIP() << support::missing_data(name);
  ForestConfig measured;
  measured.trees_file = file->string();
  measured.thinnest_stem_m = 0.03;
  ForestConfig random;
  random.stems = StemModel::inventory;
  random.radius_min_m = 0.015, random.radius_max_m = 0.8, random.square_metres_per_tree = 13.54;
  const std::vector<Stem> stems = stems_of(measured);
  EXPECT_EQ(stems.size(), 18'909u);
  std::vector<Stand> one, other;
  const auto add = [](std::vector<Stand>& stands, const std::vector<Obstacle>& trunks,
                      const ForestConfig& config) {
    Stand stand{{Vector2d(config.clear_m, -config.half_width_m),
                 Vector2d(config.clear_m + config.length_m, config.half_width_m)},
                {},
                {}};
    for (const Obstacle& trunk : trunks) {
      stand.places.push_back(trunk.from_world.head<2>());
      stand.diameters_m.push_back(2 * trunk.radius_m);
    }
    stands.push_back(stand);
  };
  for (std::uint64_t seed = 1000; seed < 1060; ++seed) {
    add(one, random_forest(random, seed), random);
    add(other, place_stems(stems, measured, seed).obstacles, measured);
  }
  const StandFigures drawn_figures = figures_of(one), measured_figures = figures_of(other);
  EXPECT_NEAR(drawn_figures.stems_per_ha / measured_figures.stems_per_ha, 1, 0.1);
  EXPECT_NEAR(drawn_figures.basal_area_m2_per_ha / measured_figures.basal_area_m2_per_ha, 1, 0.15);
  EXPECT_NEAR(drawn_figures.clark_evans, measured_figures.clark_evans, 0.06);
  EXPECT_LT(compare(one, other).ks_distance, 0.03);
}

}  // namespace
}  // namespace understory
