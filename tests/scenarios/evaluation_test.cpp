#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenarios/evaluation/flight_table.hpp"
#include "scenarios/file_output.hpp"
#include "scenarios/flight_result.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

/// CTest runs the cases side by side, each in a process of its own.
fs::path temporary_file(const std::string& name) {
  const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
  return fs::path(testing::TempDir()) / ("understory_" + test + "_" + name);
}

fs::path result_file(std::uint64_t seed, Ending ending) {
  FlightResult result;
  result.seed = seed;
  result.ending = ending;
  result.mean_speed_mps = 11.5;
  result.replans_solved = 3;
  result.replans_fallback = 1;
  result.digest = "00ff";
  const fs::path file = temporary_file("result.json");
  write_whole_file(file, to_json(result));
  return file;
}

TEST(FlightTable, KeepsRowsOfItsConfigurationOnly) {
  FlightTable table("abc");
  table.add_result(result_file(7, Ending::collision));
  table.add_result(result_file(3, Ending::goal));
  const fs::path csv = temporary_file("table.csv");
  write_whole_file(csv, table.to_csv());
  FlightTable same("abc");
  same.read(csv);
  EXPECT_TRUE(same.has(3));
  EXPECT_TRUE(same.has(7));
  EXPECT_EQ(same.to_csv(), table.to_csv());
  FlightTable other("abd");
  other.read(csv);
  EXPECT_FALSE(other.has(3));
}

TEST(FlightTable, SummaryCountsTheSeedsAskedFor) {
  FlightTable table("abc");
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    table.add_result(result_file(seed, seed == 4 ? Ending::collision : Ending::goal));
  }
  EXPECT_EQ(table.summary(1, 10).substr(0, 33), "9 of 10 reached the goal: 90.0 % ");
  EXPECT_NE(table.summary(1, 10).find("59.6 to 98.2 %"), std::string::npos);  // Wilson, 9 of 10
  EXPECT_EQ(table.summary(4, 4).substr(0, 24), "0 of 1 reached the goal:");
}

TEST(FlightTable, AHalfWrittenResultIsNoResult) {
  FlightTable table("abc");
  const fs::path file = temporary_file("half.json");
  std::ofstream(file) << "{\"outcome\": \"go";
  EXPECT_THROW(table.add_result(file), MachineError);
  EXPECT_THROW(table.add_result("/nowhere.json"), MachineError);
}

}  // namespace
}  // namespace understory
