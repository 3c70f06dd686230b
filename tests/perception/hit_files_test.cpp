#include "perception/io/hit_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <sstream>

namespace understory {
namespace {

std::vector<FrameHits> two_frames() {
  StereoHit hit;
  hit.position_camera = {-0.6635, 1.25, 3.0012};
  hit.row_px = 45;
  hit.column_px = 266;
  hit.disparity_px = 16;
  hit.score = 0.125;
  hit.edge_sum = 1062;
  hit.depth = {2.8137, 3.2154};
  return {{0, 1403715273262142976, {hit, hit}}, {7, 1403715273312142976, {hit}}};
}

/// What a PLY reader does: the header's count, then as many lines of numbers.
std::vector<std::vector<double>> vertices(const std::string& ply, std::size_t properties) {
  std::istringstream text(ply);
  std::string line;
  std::size_t count = 0, declared = 0;
  std::vector<bool> is_float;
  std::getline(text, line);
  EXPECT_EQ(line, "ply");
  while (std::getline(text, line) && line != "end_header") {
    std::sscanf(line.c_str(), "element vertex %zu", &count);
    declared += line.starts_with("property ") ? 1 : 0;
    if (line.starts_with("property ")) is_float.push_back(line.starts_with("property float "));
  }
  EXPECT_EQ(declared, properties);
  std::vector<std::vector<double>> rows;
  while (std::getline(text, line)) {
    std::istringstream cells(line);
    rows.emplace_back(std::istream_iterator<double>(cells), std::istream_iterator<double>());
    EXPECT_EQ(rows.back().size(), properties) << line;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, rows.back().size());
         ++i)  // what a reader makes of places
      if (is_float[i]) rows.back()[i] = static_cast<float>(rows.back()[i]);
  }
  EXPECT_EQ(rows.size(), count);
  return rows;
}

TEST(HitFiles, TheCsvHasALinePerHit) {
  EXPECT_EQ(hits_to_csv(two_frames()),
            "frame,t_ns,x_m,y_m,z_m,row_px,column_px,disparity_px,score,edge_sum,near_m,far_m\n"
            "0,1403715273262142976,-0.6635,1.2500,3.0012,45,266,16.00,0.125000,1062,2.8137,3.2154\n"
            "0,1403715273262142976,-0.6635,1.2500,3.0012,45,266,16.00,0.125000,1062,2.8137,3.2154\n"
            "7,1403715273312142976,-0.6635,1.2500,3.0012,45,266,16.00,0.125000,1062,2.8137,3.2154\n");
}

// Maps of poses in UTM: 5,300,006.456 m north is no float.
TEST(HitFiles, ThePlyKeepsCoordinatesOfALargeWorld) {
  const auto rows = vertices(points_to_ply({{.position_world = {499998.383, 5300006.456, 6.38}}}), 6);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_NEAR(rows[0][0], 499998.383, 1e-3);
  EXPECT_NEAR(rows[0][1], 5300006.456, 1e-3);
}

TEST(HitFiles, ThePlyCountsItsVertices) {
  const auto rows = vertices(hits_to_ply(two_frames()), 9);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NEAR(rows[2][0], -0.6635, 1e-9);
  EXPECT_NEAR(rows[2][3], 1403715273.312143, 1e-6);
  EXPECT_EQ(std::vector<double>(rows[2].begin() + 4, rows[2].end()),
            (std::vector<double>{0.125, 1062, 2.8137, 3.2154, 7}));  // what weighs a hit, and its frame
  ObstaclePoint point;
  point.position_world = {12.5, -3, 1e8};
  point.t_ns = 1'500'000'000;
  point.score = 0.25;
  point.distance_flown_m = 4;
  const auto points = vertices(points_to_ply({point}), 6);
  EXPECT_EQ(points[0], (std::vector<double>{12.5, -3, 1e8, 1.5, 0.25, 4}));
  EXPECT_TRUE(vertices(points_to_ply({}), 6).empty());
}

}  // namespace
}  // namespace understory
