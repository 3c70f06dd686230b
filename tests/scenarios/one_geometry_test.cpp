#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "scenarios/course/courses.hpp"
#include "scenarios/flight/clearance.hpp"
#include "scenarios/parts/oracles.hpp"
#include "sim/aircraft/aircraft.hpp"
#include "sim/cameras/stereo_cameras.hpp"
#include "sim/scene/leaf_contact.hpp"
#include "sim/scene/trees.hpp"
#include "tests/sim/camera_scenes.hpp"

/// What is drawn is what is hit, measured and seen by the oracle: the same shapes, computed in different
/// ways.
namespace understory {
namespace {

using Eigen::Vector3d;

const char* const models = UNDERSTORY_SOURCE_DIR "/models";

Obstacle piece(const Vector3d& from, const Vector3d& to, double radius_m, ObstacleKind kind, int tree) {
  Obstacle obstacle;
  obstacle.from_world = from;
  obstacle.to_world = to;
  obstacle.radius_m = radius_m;
  obstacle.kind = kind;
  obstacle.tree = tree;
  return obstacle;
}

/// A leaning trunk of two pieces that bend, and a branch.
Wood bent_tree() {
  Wood wood;
  wood.scenery = Scenery::woods;
  wood.obstacles = {piece({8, 0, 0}, {8.4, 0.1, 3}, 0.22, ObstacleKind::trunk, 0),
                    piece({8.4, 0.1, 3}, {8.3, 0.6, 6}, 0.21, ObstacleKind::trunk, 0),
                    piece({8.4, 0.1, 3}, {8.1, -1.6, 4}, 0.03, ObstacleKind::branch, 0)};
  Tree tree;
  tree.trunk_pieces = 2;
  tree.branches = 1;
  tree.height_m = 14;
  tree.crown_base_m = 9;
  tree.crown_radius_m = 2;
  tree.seed = 4;
  wood.trees = {tree};
  return wood;
}

Obstacle listed(ListedShape shape, const Vector3d& position_m, const Vector3d& size_m,
                const Vector3d& rotation_rad = Vector3d::Zero()) {
  ListedObstacle obstacle;
  obstacle.shape = shape;
  obstacle.position_m = position_m;
  obstacle.size_m = size_m;
  obstacle.rotation_rad = rotation_rad;
  return placed(obstacle);
}

std::vector<Obstacle> listed_shapes() {
  return {listed(ListedShape::box, {9, -2.5, 4}, {0.6, 1.0, 3}, {0.3, -0.2, 0.9}),
          listed(ListedShape::capsule, {8, 2.5, 4}, {0.4, 0.4, 4}, {0.4, 0.5, 0}),
          listed(ListedShape::sphere, {7, 0.3, 4.5}, {1, 1, 1})};
}

WorldConfig look(Scenery scenery) {
  WorldConfig config;
  config.scenery = scenery;
  config.woods = drawn({.kinds = WoodsKinds::oak, .season = Season::summer, .undergrowth = 0}, 5);
  return config;
}

/// A part of the aircraft against an obstacle, in the part's own axes.
double distance_m(const AircraftPart& part, const Eigen::Isometry3d& T_world_body, const Obstacle& obstacle) {
  const Eigen::Isometry3d T_part_world = (T_world_body * Eigen::Translation3d(part.centre_body)).inverse();
  return box_distance_m({T_part_world * obstacle.from_world, T_part_world * obstacle.to_world},
                        part.half_size_m) -
         obstacle.radius_m;
}

TEST(OneGeometry, ContactAgreesWithDistanceOverTenThousandPoses) {
  const Wood wood = bent_tree();
  const World world = build_world(models, Airframe{}, wood.obstacles, look(Scenery::woods), wood.trees);
  Aircraft aircraft(*world.model, Airframe{}, LaunchConfig{}, Wind(Vector3d::Zero()), {}, wood.obstacles);
  const std::vector<AircraftPart> parts = aircraft.shape().parts;
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  int touches = 0, decided = 0, missed = 0;
  constexpr double smallest_radius_m = 0.03;
  for (int i = 0; i < 10'000; ++i) {
    Eigen::Isometry3d pose(Eigen::AngleAxisd(3 * unit(generator), Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(0.6 * unit(generator), Vector3d::UnitY()) *
                           Eigen::AngleAxisd(1.5 * unit(generator), Vector3d::UnitX()));
    const Obstacle& one = wood.obstacles[generator() % wood.obstacles.size()];
    pose.translation() = one.from_world + (0.5 + 0.5 * unit(generator)) * (one.to_world - one.from_world) +
                         0.6 * Vector3d(unit(generator), unit(generator), unit(generator));
    if (pose.translation().z() < 1) continue;
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const AircraftPart& part : parts)
      for (const Obstacle& obstacle : wood.obstacles)
        nearest_m = std::min(nearest_m, distance_m(part, pose, obstacle));
    if (std::abs(nearest_m) < 0.001) continue;
    ++decided;
    aircraft.place(pose, {12, 0, 0}, Vector3d::Zero(), {});
    const bool agrees = (aircraft.contact() == Contact::obstacle) == (nearest_m < 0);
    // MuJoCo's capsule against a box misses now and then where the capsule's axis runs through the box. A
    // flight has ended before: it comes there through a touch.
    const bool axis_inside = nearest_m <= -smallest_radius_m + 1e-9;
    ASSERT_TRUE(agrees || axis_inside) << i << ": " << nearest_m;
    missed += !agrees;
    touches += nearest_m < 0;
  }
  EXPECT_GT(decided, 8000);
  EXPECT_LE(missed, 5);
  EXPECT_GT(touches, 1500);
}

/// The same for what a scenario lists, where boxes and spheres are whole shapes.
TEST(OneGeometry, ListedShapesCollideWhereTheyAre) {
  for (const Scenery scenery : {Scenery::plain, Scenery::woods}) {
    const std::vector<Obstacle> shapes = listed_shapes();
    const World world = build_world(models, Airframe{}, shapes, look(scenery));
    Aircraft aircraft(*world.model, Airframe{}, LaunchConfig{}, Wind(Vector3d::Zero()), {}, shapes);
    const std::vector<AircraftPart> parts = aircraft.shape().parts;
    std::mt19937_64 generator(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    int touches = 0;
    for (int i = 0; i < 2000; ++i) {
      const Obstacle& one = shapes[generator() % shapes.size()];
      Eigen::Isometry3d pose(Eigen::AngleAxisd(3 * unit(generator), Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(unit(generator), Vector3d::UnitX()));
      pose.translation() = 0.5 * (one.from_world + one.to_world) +
                           1.2 * Vector3d(unit(generator), unit(generator), unit(generator));
      const double clear_m = clearance_m(pose, Airframe{}, shapes);
      bool inside = false;  // the middle of a part of the aircraft
      for (const AircraftPart& part : parts)
        for (const Obstacle& shape : shapes)
          inside = inside || understory::distance_m(pose * part.centre_body, shape) <= 0;
      aircraft.place(pose, {12, 0, 0}, Vector3d::Zero(), {});
      if (inside) {
        ASSERT_EQ(aircraft.contact(), Contact::obstacle) << i;
      }
      if (clear_m > 0.5) {
        ASSERT_NE(aircraft.contact(), Contact::obstacle) << i;
      }
      touches += aircraft.contact() == Contact::obstacle;
    }
    EXPECT_GT(touches, 200);
  }
}

TEST(OneGeometry, BoxDistanceIsThatOfSampledPoints) {
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  const Vector3d half(0.5, 0.1, 0.3);
  for (int i = 0; i < 300; ++i) {
    const Segment segment{2 * Vector3d(unit(generator), unit(generator), unit(generator)),
                          2 * Vector3d(unit(generator), unit(generator), unit(generator))};
    double sampled_m = std::numeric_limits<double>::infinity();
    for (int step = 0; step <= 4000; ++step) {
      const Vector3d point = segment.from + step / 4000.0 * (segment.to - segment.from);
      sampled_m = std::min(sampled_m, (point.cwiseAbs() - half).cwiseMax(0).norm());
    }
    EXPECT_NEAR(box_distance_m(segment, half), sampled_m, 1e-3);
    EXPECT_LE(box_distance_m(segment, half), sampled_m + 1e-12);
  }
}

/// Depth and shape of the drawn obstacles against rays.
struct Compared {
  int pixels = 0, outline = 0;  ///< of either; that only one of both has, and that no neighbour decides
  double worst_m = 0;           ///< of depth, where a surface is not seen edgewise
};

Compared compare_with_rays(const World& world, const std::vector<Obstacle>& obstacles, int first, int last) {
  const StereoRig rig = paper_rig();
  CameraConfig config;
  config.noise_gray = 0;
  const StereoCameras cameras(world, rig, config, {});
  Eigen::Isometry3d body = Eigen::Isometry3d::Identity();
  body.translation() = Vector3d(0, 0, 4);
  const Eigen::Isometry3d T_world_camera = body * rig.T_body_camera;
  const TrueView view = cameras.true_view(body);
  const auto reach = [&](double column, double row) {
    const Vector3d ray = T_world_camera.linear() * Vector3d((column - rig.center_left_x_px) / rig.focal_px,
                                                            (row - rig.center_y_px) / rig.focal_px, 1);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Obstacle& obstacle : obstacles)
      nearest = std::min(nearest, ray_meets(T_world_camera.translation(), ray, obstacle));
    return nearest;
  };
  Compared compared;
  for (int row = 0; row < rig.height_px; ++row)
    for (int column = 0; column < rig.width_px; ++column) {
      const double depth_m = reach(column, row);
      const int number = view.objects.at<std::uint16_t>(row, column);
      const bool drawn = number >= first && number <= last, met = std::isfinite(depth_m);
      if (!drawn && !met) continue;
      const Vector3d ray((column - rig.center_left_x_px) / rig.focal_px,
                         (row - rig.center_y_px) / rig.focal_px, 1);
      const double drawn_m = view.depth_m.at<float>(row, column);
      const Vector3d place = T_world_camera * ((met ? depth_m : drawn_m) * ray);
      if (place.z() < 0.5 || place.z() > 5.7) continue;  // root and crown are drawn otherwise
      ++compared.pixels;
      if (drawn != met) {
        // Half a pixel: some ray within the pixel decides as the picture does.
        bool agrees = false;
        for (const double u : {-0.5, 0.0, 0.5})
          for (const double v : {-0.5, 0.0, 0.5})
            agrees = agrees || std::isfinite(reach(column + u, row + v)) == drawn;
        compared.outline += !agrees;
        continue;
      }
      double surface_m = std::numeric_limits<double>::infinity();
      for (const Obstacle& obstacle : obstacles)
        surface_m = std::min(surface_m, std::abs(distance_m(T_world_camera * (drawn_m * ray), obstacle)));
      const double beside = std::max(std::abs(reach(column + 0.5, row) - depth_m),
                                     std::abs(reach(column - 0.5, row) - depth_m));
      // The depth along the ray, where the surface faces the eye; its distance from the shape everywhere.
      if (beside < 0.01)
        compared.worst_m = std::max(compared.worst_m, std::abs(drawn_m - depth_m));
      else if (obstacles.front().kind != ObstacleKind::box)  // whose distance is not negative within
        compared.worst_m = std::max(compared.worst_m, surface_m);
    }
  return compared;
}

TEST(OneGeometry, DrawnTreesAreWhatRaysMeet) {
  const Wood wood = bent_tree();
  const World world = build_world(models, Airframe{}, wood.obstacles, look(Scenery::woods), wood.trees);
  const WoodsNumbers numbers{1};
  const Compared compared = compare_with_rays(world, wood.obstacles, static_cast<int>(numbers.trunk(0)),
                                              static_cast<int>(numbers.branch(0)));
  EXPECT_GT(compared.pixels, 1000);
  EXPECT_LE(compared.outline, compared.pixels / 500);
  EXPECT_LT(compared.worst_m, 0.002);
}

TEST(OneGeometry, DrawnListedShapesAreWhatRaysMeet) {
  const std::vector<Obstacle> shapes = listed_shapes();
  for (const Scenery scenery : {Scenery::plain, Scenery::woods}) {
    const World world = build_world(models, Airframe{}, shapes, look(scenery));
    const int first =
        scenery == Scenery::plain ? object_first_obstacle : static_cast<int>(WoodsNumbers{0}.alone(0));
    const Compared compared = compare_with_rays(world, shapes, first, first + 2);
    EXPECT_GT(compared.pixels, 2000);
    EXPECT_LE(compared.outline, compared.pixels / 500);
    EXPECT_LT(compared.worst_m, 0.002);
  }
}

TEST(OneGeometry, TheOracleSeesWhatRaysMeetInEveryBlock) {
  const Wood wood = bent_tree();
  std::vector<Obstacle> all = wood.obstacles;
  for (const Obstacle& shape : listed_shapes()) all.push_back(shape);
  StereoRig rig = paper_rig();
  rig.detection_depth_m = 7.5;
  TruthHistory history;
  Truth truth;
  truth.t_ns = 1;
  truth.T_world_body.translation() = Vector3d(0, 0, 4);
  truth.T_world_body.linear() = Eigen::AngleAxisd(0.4, Vector3d::UnitX()).toRotationMatrix();
  history.observe(truth);
  TrueDepth oracle(rig, all, history);
  const std::vector<StereoHit> hits = oracle.detect({1, {}, {}});
  const Eigen::Isometry3d T_world_camera = truth.T_world_body * rig.T_body_camera;
  std::size_t expected = 0;
  for (int row = 0; row <= rig.scaled_row_px(205) && row + 5 <= rig.height_px; row += 5)
    for (int column = 0; column + 5 <= rig.width_px; column += 5) {
      const Vector3d ray((column + 2 - rig.center_left_x_px) / rig.focal_px,
                         (row + 2 - rig.center_y_px) / rig.focal_px, 1);
      double depth_m = std::numeric_limits<double>::infinity();
      for (const Obstacle& obstacle : all)
        depth_m = std::min(depth_m,
                           ray_meets(T_world_camera.translation(), T_world_camera.linear() * ray, obstacle));
      if (depth_m < oracle.interval().near_m || depth_m > oracle.interval().far_m) continue;
      ASSERT_LT(expected, hits.size());
      EXPECT_NEAR((hits[expected].position_camera - depth_m * ray).norm(), 0, 1e-9);
      ++expected;
    }
  EXPECT_EQ(expected, hits.size());
  EXPECT_GT(expected, 50u);
}

TEST(OneGeometry, ClearanceByGroupsEqualsThatOfAll) {
  std::vector<Obstacle> trunks = random_forest(ForestConfig(), 1003);
  const Wood wood = grow(trunks, drawn({.lowest_branch_m = 2}, 9), 9);
  const ClearanceField field(wood.obstacles);
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 500; ++i) {
    Eigen::Isometry3d pose(Eigen::AngleAxisd(unit(generator), Vector3d::UnitX()));
    pose.translation() = Vector3d(40 + 35 * unit(generator), 20 * unit(generator), 4 + 3 * unit(generator));
    EXPECT_EQ(field.clearance_m(pose, Airframe{}), clearance_m(pose, Airframe{}, wood.obstacles));
  }
}

TEST(LeafContact, ABoxTouchesACardWhereAPointOfItIsInside) {
  std::mt19937_64 generator(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  const WingBox box{Eigen::Isometry3d(Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized())),
                    {0.4, 0.1, 0.02}};
  int touching = 0;
  for (int i = 0; i < 2000; ++i) {
    LeafCard card;
    card.middle_world = 0.6 * Vector3d(unit(generator), unit(generator), unit(generator));
    card.x_m = 0.3 * Vector3d(unit(generator), unit(generator), unit(generator));
    card.y_m = 0.2 * card.x_m.unitOrthogonal();
    bool inside = false;
    double nearest_m = 1;
    for (int u = -40; u <= 40; ++u)
      for (int v = -40; v <= 40; ++v) {
        const Vector3d point =
            box.pose.inverse() * (card.middle_world + u / 40.0 * card.x_m + v / 40.0 * card.y_m);
        const double outside_m = (point.cwiseAbs() - box.half_size_m).cwiseMax(0).norm();
        inside = inside || outside_m == 0;
        nearest_m = std::min(nearest_m, outside_m);
      }
    if (inside) {
      EXPECT_TRUE(overlaps(box, card)) << i;
    }
    if (nearest_m > 0.02) {
      EXPECT_FALSE(overlaps(box, card)) << i;
    }
    touching += inside;
  }
  EXPECT_GT(touching, 100);
}

TEST(LeafContact, AsksEveryCardWithinReach) {
  std::mt19937_64 generator(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<LeafCard> cards(4000);
  for (LeafCard& card : cards)
    card = {10 * Vector3d(unit(generator), unit(generator), 0.2 * unit(generator)),
            {0.3 * unit(generator), 0.3, 0},
            {0, 0, 0.4}};
  const Vector3d half(0.1, 0.43, 0.02);
  const LeafContact contact(cards, {{Eigen::Isometry3d::Identity(), half}});
  int touching = 0;
  for (int i = 0; i < 500; ++i) {
    Eigen::Isometry3d pose(Eigen::AngleAxisd(3 * unit(generator), Vector3d::UnitZ()));
    pose.translation() = 9 * Vector3d(unit(generator), unit(generator), 0.2 * unit(generator));
    const WingBox box{pose, half};
    const bool any = std::ranges::any_of(cards, [&](const LeafCard& card) { return overlaps(box, card); });
    EXPECT_EQ(contact.touches(pose), any);
    touching += any;
  }
  EXPECT_GT(touching, 20);
  EXPECT_LT(touching, 480);
}

}  // namespace
}  // namespace understory
