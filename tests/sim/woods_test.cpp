#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "sim/aircraft/aircraft.hpp"
#include "sim/scene/trees.hpp"
#include "tests/sim/camera_scenes.hpp"

namespace understory {
namespace {

using Eigen::Vector3d;

const char* const models = UNDERSTORY_SOURCE_DIR "/models";

std::vector<Obstacle> upright_trunks(int count) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> ahead(5, 45), aside(-20, 20), radius(0.1, 0.25);
  std::vector<Obstacle> trunks(static_cast<std::size_t>(count));
  for (Obstacle& trunk : trunks) {
    trunk.from_world = {ahead(generator), aside(generator), 0};
    trunk.to_world = trunk.from_world + Vector3d(0, 0, 9);
    trunk.radius_m = radius(generator);
    trunk.name = "tree";
  }
  return trunks;
}

Wood wood_of(int count, double lowest_branch_m = 3) {
  const WoodsConfig look = drawn({.kinds = WoodsKinds::mixed, .lowest_branch_m = lowest_branch_m}, 5);
  return grow(upright_trunks(count), look, 5);
}

World world_of(const Wood& wood, Scenery scenery) {
  WorldConfig config{.scenery = scenery, .woods = drawn({}, 5)};
  return build_world(models, Airframe{}, wood.obstacles, config,
                     scenery == Scenery::woods ? wood.trees : std::vector<Tree>{});
}

TEST(Trees, TaperFromBreastHeightAndBranchNoThinnerThanACentimetre) {
  const Wood wood = wood_of(200);
  const std::vector<Obstacle> trunks = upright_trunks(200);
  ASSERT_EQ(wood.trees.size(), trunks.size());
  for (std::size_t i = 0; i < trunks.size(); ++i) {
    const Tree& tree = wood.trees[i];
    EXPECT_EQ(wood.obstacles[tree.first].from_world, trunks[i].from_world);
    for (std::size_t piece = tree.first; piece < tree.first + tree.trunk_pieces; ++piece) {
      const Obstacle& one = wood.obstacles[piece];
      EXPECT_EQ(one.tree, static_cast<int>(i));
      EXPECT_EQ(one.kind, ObstacleKind::trunk);
      if (piece > tree.first) {
        EXPECT_EQ(one.from_world, wood.obstacles[piece - 1].to_world) << "a gap";
      }
      // A cone with the trunk's radius at 1.3 m and its tip at the tree's height.
      for (const double z : {one.from_world.z(), one.to_world.z()}) {
        const double cone_m = trunks[i].radius_m * (tree.height_m - z) / (tree.height_m - 1.3);
        EXPECT_NEAR(one.radius_m, std::max(cone_m, 0.01), 0.01) << "tree " << i << " at " << z;
      }
    }
    for (std::size_t piece = 0; piece < tree.branches; ++piece) {
      const Obstacle& branch = wood.obstacles[tree.first + tree.trunk_pieces + piece];
      EXPECT_EQ(branch.kind, ObstacleKind::branch);
      EXPECT_GE(branch.radius_m, 0.01);
      EXPECT_GT(branch.from_world.z(), 1);
    }
  }
}

/// Bourg et al. 2013: h = 2.0 d^0.68, standard deviation of log h 0.24.
TEST(Trees, AreAsHighAsMeasuredOnes) {
  const std::vector<Obstacle> trunks = upright_trunks(2000);
  const Wood wood = grow(trunks, drawn({}, 5), 5);
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < trunks.size(); ++i) {
    const double log = std::log(wood.trees[i].height_m / (2.0 * std::pow(200 * trunks[i].radius_m, 0.68)));
    sum += log, squares += log * log;
  }
  const double count = static_cast<double>(trunks.size());
  EXPECT_NEAR(sum / count, 0, 4 * 0.24 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), 0.24, 0.015);
}

TEST(Trees, AKeyThatIsSaidChangesNoOther) {
  const WoodsConfig open = drawn({}, 9), said = drawn({.undergrowth = 0.5}, 9);
  EXPECT_EQ(said.undergrowth, 0.5);
  EXPECT_EQ(open.haze_m, said.haze_m);
  EXPECT_EQ(open.kinds, said.kinds);
  EXPECT_NE(open.haze_m, drawn({}, 10).haze_m);
}

/// Lowest point at which a living branch leaves the stem; the tree's height where none does.
double lowest_branch_m(const Wood& wood, const Tree& tree) {
  double lowest_m = tree.height_m;
  for (std::size_t i = tree.first + tree.trunk_pieces; i < tree.first + tree.trunk_pieces + tree.branches;
       ++i)
    if (wood.obstacles[i].name.ends_with("_branch") &&
        wood.obstacles[i].from_world != wood.obstacles[i - 1].to_world)  // not a branch's outer piece
      lowest_m = std::min(lowest_m, wood.obstacles[i].from_world.z());
  return lowest_m;
}

TEST(Trees, BeginTheirCrownsWhereTheKeySays) {
  const Wood low = wood_of(300, 3), drawn_look = grow(upright_trunks(300), drawn({}, 5), 5);
  for (const Tree& tree : low.trees) {
    EXPECT_GE(lowest_branch_m(low, tree), 3);
    EXPECT_LE(lowest_branch_m(low, tree), 4.5);
  }
  for (const Tree& tree : drawn_look.trees) EXPECT_GE(lowest_branch_m(drawn_look, tree), 6);
}

TEST(Trees, OfThinStemsCarryTheirCrowns) {
  std::vector<Obstacle> stems = upright_trunks(50);
  for (Obstacle& stem : stems) stem.radius_m = 0.015;
  for (const double key_m : {0.0, 20.0})
    for (const Tree& tree : grow(stems, drawn({.lowest_branch_m = key_m}, 5), 5).trees)
      EXPECT_LE(tree.crown_base_m, 0.9 * tree.height_m);
}

TEST(Trees, GrowAsTheyWereMeasured) {
  const std::vector<KnownTree> known{{17, Eigen::Vector2d(0.05, -0.02), TreeKind::spruce}, {}};
  const std::vector<Obstacle> trunks = upright_trunks(2);
  const WoodsConfig look = drawn({.kinds = WoodsKinds::oak}, 5);
  const Wood wood = grow(trunks, look, 5, known), unknown = grow(trunks, look, 5);
  const Tree& tree = wood.trees[0];
  EXPECT_EQ(tree.height_m, 17);
  EXPECT_EQ(tree.kind, TreeKind::spruce);
  const Vector3d top = wood.obstacles[tree.first + tree.trunk_pieces - 1].to_world - trunks[0].from_world;
  EXPECT_NEAR(top.x(), 0.05 * top.z(), 0.02);  // a spruce hardly bends
  EXPECT_NEAR(top.y(), -0.02 * top.z(), 0.02);
  EXPECT_EQ(wood.trees[1].height_m, unknown.trees[1].height_m);
  EXPECT_EQ(wood.trees[1].kind, TreeKind::oak);
}

/// Number of corners below 6 m of the far wood's stems and thickets that are nearer to the course than a
/// distance. Crowns of far trees may hang over it.
int far_corners_near(const Eigen::AlignedBox2d& course, double within_m, const World& world, int far_wood) {
  int near = 0;
  for (const WoodsPart& part : world.woods->parts) {
    const WoodsTriangles& triangles = world.woods->pieces[part.piece].triangles;
    const bool is_tree = part.solid[0].count > 0;
    const WoodsRange& range = is_tree ? part.solid[0] : part.leaves[0];
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
      const WoodsVertex& corner = triangles.vertices[triangles.indices[i]];
      if (corner.object[0] + 256 * corner.object[1] != far_wood || corner.position_world[2] > 6) continue;
      const Eigen::Vector2d place(corner.position_world[0], corner.position_world[1]);
      near += course.exteriorDistance(place) < (is_tree ? within_m : 1e-6);
    }
  }
  return near;
}

/// A sparse wood: between its trees and the sides of the course nothing stands that cannot be hit.
TEST(Woods, NoFarWoodStandsWithinTheCourse) {
  const Wood wood = wood_of(3);
  const WorldConfig config{.scenery = Scenery::woods, .woods = drawn({}, 5)};
  const Eigen::AlignedBox2d course(Eigen::Vector2d(-25, -25), Eigen::Vector2d(75, 25));
  const auto number = static_cast<int>(WoodsNumbers{3}.far_wood());
  const World anywhere = build_world(models, Airframe{}, wood.obstacles, config, wood.trees);
  const World beyond = build_world(models, Airframe{}, wood.obstacles, config, wood.trees, course);
  EXPECT_GT(far_corners_near(course, 1, anywhere, number), 20);
  EXPECT_EQ(far_corners_near(course, 1, beyond, number), 0);
  const Eigen::AlignedBox2d all(Eigen::Vector2d(-200, -200), Eigen::Vector2d(200, 200));
  EXPECT_GT(far_corners_near(all, 1, beyond, number), 100);
}

/// The pool against a model that holds every capsule.
TEST(Woods, PooledCapsulesCollideAsAllOfThemWould) {
  const Wood wood = wood_of(12);
  const World pooled = world_of(wood, Scenery::woods), all = world_of(wood, Scenery::plain);
  ASSERT_EQ(all.flown, nullptr) << wood.obstacles.size() << " pieces are too many for a geom each";
  Aircraft near(*pooled.model, Airframe{}, LaunchConfig{}, Wind(Vector3d::Zero()), {}, wood.obstacles);
  Aircraft full(*all.model, Airframe{}, LaunchConfig{}, Vector3d::Zero());
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  int touches = 0;
  for (int i = 0; i < 3000; ++i) {
    const Obstacle& one = wood.obstacles[generator() % wood.obstacles.size()];
    Eigen::Isometry3d pose(Eigen::AngleAxisd(3 * unit(generator), Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(1.5 * unit(generator), Vector3d::UnitX()));
    pose.translation() = one.from_world + (0.5 + 0.5 * unit(generator)) * (one.to_world - one.from_world) +
                         0.7 * Vector3d(unit(generator), unit(generator), unit(generator));
    near.place(pose, {12, 0, 0}, Vector3d::Zero(), {});
    full.place(pose, {12, 0, 0}, Vector3d::Zero(), {});
    ASSERT_EQ(near.contact(), full.contact()) << i;
    touches += near.contact() == Contact::obstacle;
  }
  EXPECT_GT(touches, 300);
}

TEST(Woods, MorePiecesThanThePoolHoldsEndTheProgram) {
  Wood wood = wood_of(1);
  Obstacle twig = wood.obstacles.back();
  twig.from_world = Vector3d(30, 0, 4.3), twig.to_world = Vector3d(30, 0.3, 4.3);  // above the wing
  const auto placed_among = [&](int twigs) {
    Wood thick = wood;
    thick.obstacles.insert(thick.obstacles.end(), static_cast<std::size_t>(twigs), twig);
    const World world = world_of(wood, Scenery::woods);
    Aircraft aircraft(*world.model, Airframe{}, LaunchConfig{}, Wind(Vector3d::Zero()), {}, thick.obstacles);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Vector3d(30, 0, 4);
    aircraft.place(pose, {12, 0, 0}, Vector3d::Zero(), {});
  };
  EXPECT_NO_THROW(placed_among(pooled_geoms));
  EXPECT_THROW(placed_among(pooled_geoms + 1), SimulationError);
}

CameraConfig exact_camera() {
  CameraConfig config;
  config.noise_gray = 0;
  return config;
}

Eigen::Isometry3d pose_at(double x_m, double bank_rad = 0) {
  Eigen::Isometry3d pose(Eigen::AngleAxisd(bank_rad, Vector3d::UnitX()));
  pose.translation() = Vector3d(x_m, 0, 4);
  return pose;
}

/// What is drawn is what is hit: where the picture shows a trunk, its depth is that of the capsules.
TEST(Woods, DrawnTrunksLieWhereTheirCapsulesAre) {
  const Wood wood = wood_of(60, 8);
  const World world = world_of(wood, Scenery::woods);
  const StereoRig rig = paper_rig();
  const StereoCameras cameras(world, rig, exact_camera(), {});
  int checked = 0;
  for (const double x_m : {0.0, 8.0}) {
    const Eigen::Isometry3d body = pose_at(x_m);
    const TrueView view = cameras.true_view(body);
    const Eigen::Isometry3d T_world_camera = body * rig.T_body_camera;
    for (int row = 0; row < rig.height_px; row += 3)
      for (int column = 0; column < rig.width_px; ++column) {
        const int number = view.objects.at<std::uint16_t>(row, column) - object_first_obstacle;
        if (number < 0 || number % 3 != 0 || number / 3 >= static_cast<int>(wood.trees.size())) continue;
        const double depth_m = view.depth_m.at<float>(row, column);
        const Vector3d place =
            T_world_camera * (depth_m * Vector3d((column - rig.center_left_x_px) / rig.focal_px,
                                                 (row - rig.center_y_px) / rig.focal_px, 1));
        if (depth_m > 11 || place.z() < 1 || place.z() > 6) continue;  // far away with fewer sides; the band
        const Tree& tree = wood.trees[static_cast<std::size_t>(number) / 3];
        double nearest_m = 1e9;
        for (std::size_t i = tree.first; i < tree.first + tree.trunk_pieces; ++i) {
          const Obstacle& piece = wood.obstacles[i];
          const Vector3d along = piece.to_world - piece.from_world;
          const double share =
              std::clamp((place - piece.from_world).dot(along) / along.squaredNorm(), 0.0, 1.0);
          nearest_m = std::min(nearest_m,
                               std::abs((place - piece.from_world - share * along).norm() - piece.radius_m));
        }
        ASSERT_LT(nearest_m, 0.01) << "tree " << number / 3 << " at " << place.transpose();
        ++checked;
      }
  }
  EXPECT_GT(checked, 2000);
}

/// A large wood keeps no triangles. What is near is grown again, and again where the aircraft has flown on.
TEST(Woods, PiecesThatAreGrownAgainAreDrawnAsTheyWere) {
  const Wood wood = wood_of(60);
  const World kept = world_of(wood, Scenery::woods), dropped = world_of(wood, Scenery::woods);
  for (WoodsPiece& piece : dropped.woods->pieces) {
    ASSERT_FALSE(piece.triangles.indices.empty());
    piece.triangles = {};
  }
  StereoCameras seeing(kept, paper_rig(), exact_camera(), {}),
      again(dropped, paper_rig(), exact_camera(), {});
  for (const double x_m : {-10.0, 25.0, 60.0, -10.0}) {
    const Eigen::Isometry3d body = pose_at(x_m, 0.3);
    const cv::Mat picture = seeing.capture(body, 0).left.clone();
    cv::Scalar mean, deviation;
    cv::meanStdDev(picture, mean, deviation);
    EXPECT_GT(deviation[0], 5) << "something is to be seen at " << x_m;
    EXPECT_EQ(cv::norm(picture, again.capture(body, 0).left, cv::NORM_INF), 0) << "at " << x_m;
    EXPECT_EQ(cv::norm(seeing.true_view(body).objects, again.true_view(body).objects, cv::NORM_INF), 0);
  }
}

TEST(Woods, InvisibleTreesAreInNoPictureAndTouchedAllTheSame) {
  const Wood wood = wood_of(60);
  WorldConfig config{.obstacles_visible = false, .scenery = Scenery::woods, .woods = drawn({}, 5)};
  const World invisible = build_world(models, Airframe{}, wood.obstacles, config, wood.trees);
  const World visible = world_of(wood, Scenery::woods);
  const StereoCameras cameras(invisible, paper_rig(), exact_camera(), {});
  const StereoCameras seeing(visible, paper_rig(), exact_camera(), {});
  const cv::Mat seen = seeing.true_view(pose_at(2)).objects, unseen = cameras.true_view(pose_at(2)).objects;
  const int last = object_first_obstacle + static_cast<int>(3 * wood.trees.size()) - 1;
  const auto trees_in = [&](const cv::Mat& objects) {
    return cv::countNonZero((objects >= object_first_obstacle) & (objects <= last));
  };
  EXPECT_GT(trees_in(seen), 1000);
  EXPECT_EQ(trees_in(unseen), 0);
  EXPECT_GT(cv::countNonZero(unseen > last), 1000) << "undergrowth, logs and the far wood are still there";
  EXPECT_EQ(invisible.woods->leaf_cards.size(), visible.woods->leaf_cards.size());
}

/// OpenGL's state is shared with MuJoCo: neither kind of scenery changes the other's pictures.
TEST(Woods, PlainAndWoodsInOneProcessEqualEachAlone) {
  const Wood wood = wood_of(30);
  const World plain = world_of(wood, Scenery::plain), woods = world_of(wood, Scenery::woods);
  const auto picture = [](StereoCameras& cameras) {
    return cameras.capture(pose_at(2, 0.4), 0).left.clone();
  };
  cv::Mat plain_alone, woods_alone;
  {
    StereoCameras cameras(plain, paper_rig(), exact_camera(), {});
    plain_alone = picture(cameras);
  }
  {
    StereoCameras cameras(woods, paper_rig(), exact_camera(), {});
    woods_alone = picture(cameras);
  }
  StereoCameras first(plain, paper_rig(), exact_camera(), {}), second(woods, paper_rig(), exact_camera(), {});
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(cv::norm(picture(first), plain_alone, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(picture(second), woods_alone, cv::NORM_INF), 0);
    first.depth(pose_at(3));
    second.true_view(pose_at(3));
    second.chase_view({.T_world_body = pose_at(3)}, 320, 200);
  }
  EXPECT_GT(cv::norm(plain_alone, woods_alone, cv::NORM_INF), 20);
}

}  // namespace
}  // namespace understory
