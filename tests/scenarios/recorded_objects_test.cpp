#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "scenarios/evaluation/evaluation_recording.hpp"

namespace understory {
namespace {

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
    try {
      parse_recorded_objects(text, "objects.csv");
      FAIL() << text;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).find("objects.csv:1: expected"), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace understory
