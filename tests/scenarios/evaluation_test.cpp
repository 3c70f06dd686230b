#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <random>
#include <stdexcept>
#include <string>

#include "perception/pushbroom/pushbroom_stereo.hpp"
#include "scenarios/evaluation/evaluation_recording.hpp"
#include "scenarios/evaluation/ground_truth.hpp"
#include "scenarios/evaluation/obstacle_sightings.hpp"
#include "scenarios/evaluation/published_evaluations.hpp"
#include "scenarios/evaluation/vision_tally.hpp"
#include "tests/perception/rigs.hpp"
#include "tests/support/synthetic_stereo.hpp"
#include "tests/support/text.hpp"

namespace understory {
namespace {

constexpr int trunk = 2;
const std::map<int, std::string> kinds{{1, "ground"}, {trunk, "trunk"}};

/// All of the picture is one surface square to the axis.
TrueImages plane_truth(const StereoRig& rig, double depth_m, int object = trunk) {
  TrueImages truth{cv::Mat(rig.height_px, rig.width_px, CV_16UC1, cv::Scalar(std::round(1000 * depth_m))),
                   cv::Mat(rig.height_px, rig.width_px, CV_16UC1, cv::Scalar(object)),
                   {}};
  truth.shared_depth_mm = shared_depth(truth.depth_mm, rig);
  return truth;
}

struct Plane {
  StereoRig rig;
  DetectionGrid grid;
  EvaluationFrame frame;
  Plane(const char* name, double beyond_m)
      : rig(support::house_rig(name)), grid(rig, {}, robust_pushbroom().last_row_px) {
    support::SyntheticPlane plane;
    plane.depth_m = grid.depths[0].depth_m + beyond_m;
    frame.pair = support::render_plane(rig, plane);
    frame.truth = plane_truth(rig, plane.depth_m);
    frame.T_world_camera = frame.T_odometry_camera = Eigen::Isometry3d::Identity();
  }
  VisionTally judged(const std::vector<StereoHit>& hits) const {
    VisionTally result;
    tally(frame, grid, rig, kinds, due_blocks(frame.truth, grid), hits, result);
    return result;
  }
};

TEST(Evaluation, APlaneAtTheDetectionDepthHasPrecisionOne) {
  for (const char* name : {"long.yaml", "paper.yaml"}) {
    Plane plane(name, 0);
    for (const PushbroomConfig& rule : {original_pushbroom(), robust_pushbroom()}) {
      PushbroomStereo detector(plane.rig, rule);
      const auto& hits = detector.detect(plane.frame.pair);
      ASSERT_GT(hits.size(), 200u);  // the rest is saturated or plain
      const VisionTally result = plane.judged(hits);
      for (const Rates& rates : result.rates) {
        EXPECT_EQ(rates.precision.of, static_cast<std::int64_t>(hits.size()));
        EXPECT_EQ(rates.precision.value(), 1);
      }
      EXPECT_TRUE(result.false_on.empty());
      // Every block that can match is expected; recall is the share of them that did.
      EXPECT_EQ(result.at_one_pixel().recall.with, static_cast<std::int64_t>(hits.size()));
      EXPECT_EQ(result.at_one_pixel().recall.of,
                (plane.grid.columns - plane.grid.first_column(0)) * plane.grid.rows);
    }
  }
}

/// The left half of the picture is ground at the right depth, the right half a trunk too far away.
TEST(Evaluation, TrunkPrecisionLeavesOutTrueHitsOnOtherSurfaces) {
  Plane plane("long.yaml", 0);
  const auto hits = true_depth_hits(plane.frame.truth, plane.grid, plane.rig);
  const auto judged_with = [&](int left_object) {
    const cv::Rect left(0, 0, plane.rig.width_px / 2, plane.rig.height_px);
    plane.frame.truth = plane_truth(plane.rig, 20);
    const TrueImages near = plane_truth(plane.rig, plane.grid.depths[0].depth_m, left_object);
    near.depth_mm(left).copyTo(plane.frame.truth.depth_mm(left));
    near.objects(left).copyTo(plane.frame.truth.objects(left));
    return plane.judged(hits).at_one_pixel();
  };
  const Rates on_ground = judged_with(1), on_trunks = judged_with(trunk);
  EXPECT_EQ(on_ground.precision.of, static_cast<std::int64_t>(hits.size()));
  EXPECT_NEAR(on_ground.precision.value(), 0.5, 0.1);
  EXPECT_EQ(on_ground.trunk_precision.with, 0);
  EXPECT_EQ(on_ground.trunk_precision.of, on_ground.precision.of - on_ground.precision.with);
  EXPECT_EQ(on_trunks.precision.with, on_ground.precision.with);
  EXPECT_EQ(on_trunks.trunk_precision.with, on_trunks.precision.with);
  EXPECT_EQ(on_trunks.trunk_precision.of, on_trunks.precision.of);
}

TEST(Evaluation, WhatKnowsTheTruthIsRightAndMissesNothing) {
  Plane plane("long.yaml", 0.1);
  const auto hits = true_depth_hits(plane.frame.truth, plane.grid, plane.rig);
  const VisionTally result = plane.judged(hits);
  EXPECT_EQ(result.at_one_pixel().precision.value(), 1);
  EXPECT_EQ(result.at_one_pixel().recall.value(), 1);
  EXPECT_EQ(result.at_one_pixel().f_score(), 1);
}

TEST(Evaluation, ADetectorMovedBySevenDecimetresLandsInTheRightBin) {
  Plane plane("long.yaml", 0.7);
  auto hits = true_depth_hits(plane_truth(plane.rig, plane.grid.depths[0].depth_m), plane.grid, plane.rig);
  const VisionTally result = plane.judged(hits);
  EXPECT_EQ(result.rates[0].precision.value(), 0);        // 0.25 m
  EXPECT_EQ(result.rates[1].precision.value(), 0);        // 0.50 m
  EXPECT_EQ(result.rates[2].precision.value(), 1);        // 1.00 m
  EXPECT_EQ(result.at_one_pixel().precision.value(), 1);  // a pixel is 0.86 m there

  // The paper's second evaluation: points remembered 0.7 m in front of what StereoBM sees.
  PublishedEvaluations evaluations(plane.rig, plane.grid, LocalMapConfig());
  const cv::Mat depth_m(plane.rig.height_px, plane.rig.width_px, CV_32FC1,
                        cv::Scalar(plane.grid.depths[0].depth_m + 0.7));
  evaluations.remember(plane.frame, hits);
  evaluations.compare(plane.frame, hits, depth_m);
  const PublishedScores& scores = evaluations.scores();
  EXPECT_EQ(scores.false_positives.share_within(0.5), 0);
  EXPECT_EQ(scores.false_positives.share_within(1.0), 1);
  EXPECT_GT(scores.false_positives.bins[1], 500);           // 0.5 to 1 m
  EXPECT_EQ(scores.single_frame.share_without_match(), 1);  // StereoBM is cropped to 0.5 m
  EXPECT_EQ(scores.false_negatives.total(), 0);             // nothing nearer than 5 m
}

TEST(Evaluation, NothingSeenByStereoBmCountsAsTenMetres) {
  Plane plane("paper.yaml", 0);
  const auto hits = true_depth_hits(plane.frame.truth, plane.grid, plane.rig);
  PublishedEvaluations evaluations(plane.rig, plane.grid, LocalMapConfig());
  evaluations.remember(plane.frame, hits);
  evaluations.compare(plane.frame, hits, cv::Mat::zeros(plane.rig.height_px, plane.rig.width_px, CV_32FC1));
  EXPECT_EQ(evaluations.scores().false_positives.share_within(9.5), 0);
  EXPECT_EQ(evaluations.scores().false_positives.share_within(10), 1);
  EXPECT_EQ(evaluations.scores().single_frame.share_without_match(), 1);
}

TEST(Evaluation, PerfectMemoryMissesNothing) {
  Plane plane("paper.yaml", 0);
  const auto hits = true_depth_hits(plane.frame.truth, plane.grid, plane.rig);
  PublishedEvaluations evaluations(plane.rig, plane.grid, LocalMapConfig());
  evaluations.remember(plane.frame, hits);
  // Two metres on, the plane is nearer than 5 m still, and where memory has it.
  plane.frame.T_odometry_camera->translation().z() += 2;
  plane.frame.pair.t_ns += 200'000'000;
  evaluations.remember(plane.frame, {});
  const double depth_m = plane.grid.depths[0].depth_m - 2;
  evaluations.compare(plane.frame, {},
                      cv::Mat(plane.rig.height_px, plane.rig.width_px, CV_32FC1, cv::Scalar(depth_m)));
  EXPECT_EQ(evaluations.scores().false_positives.share_within(0.5), 1);
  // The columns left of the first that can match were never seen, and rows below the last: within 2 m all the
  // same.
  EXPECT_GT(evaluations.scores().false_negatives.share_within(1), 0.9);
}

TEST(Evaluation, ARandomDetectorScoresWhatGeometryPredicts) {
  const StereoRig rig = support::house_rig("long.yaml");
  const DetectionGrid grid(rig, {}, 205);
  // A trunk of 12 of the columns that can match, from top to bottom; elsewhere the sky.
  EvaluationFrame frame;
  frame.truth = {cv::Mat::zeros(rig.height_px, rig.width_px, CV_16UC1),
                 cv::Mat::zeros(rig.height_px, rig.width_px, CV_16UC1),
                 {}};
  const cv::Rect place(30 * truth_block_px, 0, 12 * truth_block_px, rig.height_px);
  frame.truth.depth_mm(place).setTo(std::round(1000 * grid.depths[0].depth_m));
  frame.truth.objects(place).setTo(trunk);
  frame.truth.shared_depth_mm = shared_depth(frame.truth.depth_mm, rig);
  std::mt19937_64 generator(5);
  constexpr int count = 40, frames = 2000;
  VisionTally result;
  const DueBlocks due = due_blocks(frame.truth, grid);
  for (int i = 0; i < frames; ++i)
    tally(frame, grid, rig, kinds, due, random_hits(count, grid, rig, generator), result);

  const int columns = grid.columns - grid.first_column(0);
  const double share = 12.0 / columns;
  const double sigma = std::sqrt(share * (1 - share) / (count * frames));
  EXPECT_NEAR(result.at_one_pixel().precision.value(), share, 4 * sigma);
  const double blocks = columns * grid.rows;
  const double found = 1 - std::pow(1 - 1 / blocks, count);  // a given block, by any of the hits
  EXPECT_NEAR(result.at_one_pixel().recall.value(), found, 0.02 * found);
  // What is wrong lies on the sky.
  EXPECT_EQ(result.false_on.size(), 1u);
  EXPECT_EQ(result.false_on.begin()->first, "sky");
}

TEST(Evaluation, AFifthOfABlockMakesItTrue) {
  const StereoRig rig = support::house_rig("long.yaml");
  TrueImages truth = plane_truth(rig, 30, 1);
  const auto put = [&](int pixels) {
    for (int i = 0; i < pixels; ++i) {
      truth.depth_mm.at<std::uint16_t>(100 + i / 5, 200 + i % 5) = 10'000;
      truth.objects.at<std::uint16_t>(100 + i / 5, 200 + i % 5) = trunk;
    }
  };
  put(4);
  EXPECT_FALSE(content_between(truth, 200, 100, {9.5, 10.5}, Surfaces::obstacles).holds());
  put(5);
  const BlockContent content = content_between(truth, 200, 100, {9.5, 10.5}, Surfaces::obstacles);
  EXPECT_TRUE(content.holds());
  EXPECT_EQ(content.object, trunk);
  EXPECT_NEAR(content.mean_depth_m, 10, 1e-9);
  EXPECT_FALSE(content_between(truth, 200, 100, {10.5, 11}, Surfaces::obstacles).holds());
  StereoHit hit;
  hit.column_px = 200;
  hit.row_px = 100;
  hit.position_camera.z() = 8;
  EXPECT_EQ(lies_on(hit, truth, kinds), "edge of trunk");
  hit.row_px = 150;
  EXPECT_EQ(lies_on(hit, truth, kinds), "ground");
}

TEST(Evaluation, WhatTheRightEyeDoesNotSeeIsNotDue) {
  // A trunk 40 px wide at 10 m; another 5 m away stands right of it in the left image and covers part of it
  // in the right one: as many columns as the disparities differ by, less the gap between the two.
  const StereoRig rig = support::house_rig("long.yaml");
  cv::Mat depth_mm = cv::Mat::zeros(rig.height_px, rig.width_px, CV_16UC1);
  constexpr int from_px = 150, width_px = 40, gap_px = 3;
  depth_mm(cv::Rect(from_px, 0, width_px, rig.height_px)).setTo(10'000);
  depth_mm(cv::Rect(from_px + width_px + gap_px, 0, 60, rig.height_px)).setTo(5'000);
  const cv::Mat shared = shared_depth(depth_mm, rig);
  const double covered_px = rig.disparity_px(5) - rig.disparity_px(10) - gap_px;
  int kept_px = 0;
  for (int u = from_px; u < from_px + width_px; ++u) kept_px += shared.at<std::uint16_t>(100, u) != 0;
  EXPECT_NEAR(kept_px, width_px - covered_px, 1);
  EXPECT_NE(shared.at<std::uint16_t>(100, from_px), 0);                      // its left side is seen
  EXPECT_EQ(shared.at<std::uint16_t>(100, from_px + width_px - 1), 0);       // its right one is not
  EXPECT_NE(shared.at<std::uint16_t>(100, from_px + width_px + gap_px), 0);  // what covers it is
}

/// Straight past a trunk that shows one block, hit each time, for the four frames 98 to 101: at 10 m. Frames
/// are 8 ms apart.
struct TrunkPassed {
  StereoRig rig = support::house_rig("long.yaml");
  DetectionGrid grid{rig, {}, 205};
  std::vector<RecordedObject> objects{{1, "ground", "ground", {}, {}, 0},
                                      {trunk, "tree_0", "trunk", {20, 1.2, 0}, {20, 1.2, 9}, 0.2},
                                      {3, "tree_1", "trunk", {80, 0, 0}, {80, 0, 9}, 0.2},
                                      {4, "tree_2", "trunk", {20, -0.3, 0}, {20, -0.3, 9}, 0.2}};

  template <typename Visit>
  void for_each_frame(Visit&& visit) const {
    for (int i = 0; i <= 300; ++i) {
      EvaluationFrame frame;
      frame.pair.t_ns = std::int64_t{8'000'000} * i;
      frame.truth = plane_truth(rig, 40, 0);
      frame.T_world_camera = Eigen::Isometry3d::Identity();
      frame.T_world_camera->translation() = Eigen::Vector3d(0.1 * i, 0, 4);
      std::vector<StereoHit> hits;
      if (i >= 98 && i < 102) {
        const cv::Rect block(200, 100, 5, 5);
        frame.truth.depth_mm(block).setTo(1000 * (20 - 0.1 * i));
        frame.truth.objects(block).setTo(trunk);
        frame.truth.shared_depth_mm = frame.truth.depth_mm;
        hits.push_back(hit_on_block(rig, grid.depths[0], 200, 100));
      }
      visit(frame, expected_blocks(frame.truth, grid), hits);
    }
  }
};

TEST(Evaluation, ObstaclesAreFollowedUntilTheyArePassed) {
  const TrunkPassed flight;
  ObstacleSightings sightings(flight.objects, 0);
  flight.for_each_frame([&](const EvaluationFrame& frame, const auto& due, const auto& hits) {
    sightings.add(frame, flight.grid, due, hits);
  });
  const auto passed = sightings.passed(sightings.passings());
  ASSERT_EQ(passed.size(), 2u);  // neither the ground nor what lies beyond the path's end
  EXPECT_EQ(passed[0].object, trunk);
  EXPECT_NEAR(passed[0].miss_m, 1.0, 1e-6);
  EXPECT_EQ(passed[0].blocks_in_view, 4);  // 9.9 to 10.2 m: within half a pixel of 10.14 m
  EXPECT_EQ(passed[0].hits, 4);
  EXPECT_NEAR(passed[0].first_hit_m, 10.2, 1e-6);
  EXPECT_NEAR(passed[0].third_hit_m, 10.0, 1e-6);
  EXPECT_FALSE(passed[0].on_the_path);  // 1 m beside a wing of 0.43 m
  EXPECT_TRUE(passed[1].hidden());      // it never came into view
}

TEST(Evaluation, ASlowComputerLosesWhatPassesBetweenItsLooks) {
  const TrunkPassed flight;
  constexpr double four_frames_s = 0.032;  // frames 0, 4 ... 300: of the trunk's four it looks at 100
  PacedSightings paced(flight.objects, 0, four_frames_s);
  ObstacleSightings unpaced(flight.objects, 0);
  flight.for_each_frame([&](const EvaluationFrame& frame, const auto& due, const auto& hits) {
    paced.add(frame, frame.pair.t_ns + 8'000'000, flight.grid, due, hits);
    unpaced.add(frame, flight.grid, due, hits);
  });
  const PacedResult result = paced.result(unpaced.passings());
  EXPECT_EQ(result.frames, 76);
  ASSERT_EQ(result.sightings.size(), 2u);
  EXPECT_EQ(result.sightings[0].hits, 1);
  EXPECT_FALSE(result.sightings[0].found());
  EXPECT_FALSE(result.sightings[0].hidden());  // it was there to be seen
}

TEST(Evaluation, NearestDistancesAreThoseOfBruteForce) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> place(-5, 5);
  std::vector<Eigen::Vector3d> from(200), to(700);
  for (auto* points : {&from, &to})
    for (Eigen::Vector3d& point : *points) point = {place(generator), place(generator), place(generator)};
  const auto distances_m = nearest_distances_m(from, to);
  for (std::size_t i = 0; i < from.size(); ++i) {
    double minimum = 1e9;
    for (const Eigen::Vector3d& other : to) minimum = std::min(minimum, (from[i] - other).norm());
    EXPECT_DOUBLE_EQ(distances_m[i], minimum);
  }
  EXPECT_TRUE(std::isinf(nearest_distances_m(from, {}).front()));
}

TEST(Evaluation, HistogramsCountEdgesToTheNearerBin) {
  constexpr double beyond = std::numeric_limits<double>::infinity();
  DistanceHistogram histogram;
  for (const double distance_m : {0.0, 0.5, 0.500001, 1.0, 7.0, 12.0, beyond, beyond})
    histogram.add(distance_m);
  EXPECT_EQ(histogram.total(), 8);
  EXPECT_DOUBLE_EQ(histogram.share_within(0.5), 2 / 8.0);
  EXPECT_DOUBLE_EQ(histogram.share_within(1.0), 4 / 8.0);
  EXPECT_DOUBLE_EQ(histogram.share_within(10), 5 / 8.0);
  EXPECT_DOUBLE_EQ(histogram.share_without_match(), 2 / 8.0);
}

TEST(Evaluation, LooksWhereTheDetectorLooks) {
  for (const char* name : {"long.yaml", "paper.yaml"}) {
    const StereoRig rig = support::house_rig(name);
    const PushbroomStereo detector(rig, robust_pushbroom());
    const DetectionDepth depth = detection_depth(rig, rig.detection_depth_m);
    EXPECT_EQ(depth.disparity_px, detector.detection_disparity_px());
    EXPECT_EQ(depth.depth_m, detector.detection_depth_m());
    EXPECT_EQ(depth.one_pixel.near_m, detector.one_pixel_interval().near_m);
    EXPECT_EQ(depth.one_pixel.far_m, detector.one_pixel_interval().far_m);
  }
}

TEST(RecordedObjects, AreReadOrRefusedInOneLine) {
  const auto objects = parse_recorded_objects(
      "#number,name,kind,...\n1,ground,ground,0,0,0,0,0,0,0\n2,tree,trunk,1,2,0,1,2,8,0.15\n", "objects.csv");
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_FALSE(objects[0].is_obstacle());
  EXPECT_EQ(objects[1].kind, "trunk");
  EXPECT_EQ(objects[1].to_world, Eigen::Vector3d(1, 2, 8));
  for (const char* text :
       {"2,tree,trunk,1,2,0,1,2,8\n", "0,tree,trunk,1,2,0,1,2,8,0.1\n", "x,tree,trunk,1,2,0,1,2,8,0.1\n",
        "2,tree,trunk,1,nan,0,1,2,8,0.1\n", "2,tree,trunk,1,2,0,1,2,8,-0.1\n"}) {
    EXPECT_EQ(
        support::refusal_of([&] { parse_recorded_objects(text, "objects.csv"); }).find("objects.csv:1: "), 0u)
        << text;
  }
}

}  // namespace
}  // namespace understory
