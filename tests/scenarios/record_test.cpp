#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "scenarios/config/config_tree.hpp"
#include "scenarios/flight/flight_result.hpp"
#include "scenarios/flight/run_digest.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;

struct Folder {
  fs::path path =
      fs::path(testing::TempDir()) /
      ("understory_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  Folder() {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
};

std::string content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(FileOutput, WritesWhole) {
  const Folder folder;
  write_whole_file(folder.path / "a.txt", "first");
  write_whole_file(folder.path / "a.txt", "second");
  EXPECT_EQ(content(folder.path / "a.txt"), "second");
  EXPECT_FALSE(fs::exists(folder.path / "a.txt.part"));
}

TEST(FileOutput, AFullDiskIsTheMachinesFaultAndLeavesNothing) {
  const Folder folder;
  fs::create_symlink("/dev/full", folder.path / "result.json.part");  // writes there fail as on a full disk
  EXPECT_THROW(write_whole_file(folder.path / "result.json", std::string(100'000, 'x')), MachineError);
  EXPECT_FALSE(fs::exists(folder.path / "result.json"));
  EXPECT_FALSE(fs::exists(fs::symlink_status(folder.path / "result.json.part")));
  fs::create_symlink("/dev/full", folder.path / "small.json.part");  // small enough to fail only when flushed
  EXPECT_THROW(write_whole_file(folder.path / "small.json", "x"), MachineError);
}

TEST(FileOutput, AnUnwritableFolderIsBadInput) {
  const Folder folder;
  write_whole_file(folder.path / "file", "in the way");
  EXPECT_THROW(prepare_output_folder(folder.path / "file" / "runs"), ScenarioError);
  EXPECT_THROW(prepare_output_folder(folder.path / "file"), ScenarioError);
  EXPECT_THROW(prepare_output_folder("/proc/runs"), ScenarioError);
  EXPECT_THROW(write_whole_file(folder.path / "none" / "a.txt", "x"), ScenarioError);
  EXPECT_NO_THROW(prepare_output_folder(folder.path / "new" / "runs"));
}

TEST(RunDigest, EveryBitAndTheOrderCount) {
  const auto digest = [](auto... words) {
    RunDigest running;
    (running.add(words), ...);
    return running.hex();
  };
  EXPECT_EQ(digest(1.0, 2.0), digest(1.0, 2.0));
  EXPECT_NE(digest(1.0, 2.0), digest(2.0, 1.0));
  EXPECT_NE(digest(1.0), digest(std::nextafter(1.0, 2.0)));
  EXPECT_NE(digest(0.0), digest(-0.0));
  EXPECT_EQ(digest().size(), 16u);
  std::vector<std::byte> image(1001);
  const auto hash = [&] {
    RunDigest running;
    running.add(std::span<const std::byte>(image));
    return running.hex();
  };
  std::set<std::string> hashes{hash()};
  for (std::size_t at = 0; at < image.size(); ++at) {  // in every chain, and in what is left over
    image[at] = std::byte{1};
    hashes.insert(hash());
    image[at] = std::byte{};
  }
  EXPECT_EQ(hashes.size(), image.size() + 1);
  for (std::size_t at = 0; at + 64 < image.size();
       ++at) {  // neighbours and those a round apart change places
    image[at] = std::byte{2};
    image[at + 1] = image[at + 8] = image[at + 64] = std::byte{3};
    hashes.insert(hash());
    image[at] = image[at + 1] = image[at + 8] = image[at + 64] = std::byte{};
  }
  EXPECT_EQ(hashes.size(), 2 * image.size() + 1 - 64);
}

TEST(FlightResult, JsonSaysWhatHappened) {
  FlightResult result;
  result.ending = Ending::collision;
  result.seed = 12;
  result.min_clearance_m = std::numeric_limits<double>::infinity();
  result.timings = {{"detect", 2, 0.004, 0.003}};
  const auto json = nlohmann::json::parse(to_json(result));
  EXPECT_EQ(json["outcome"], "collision");
  EXPECT_EQ(json["seed"], 12);
  EXPECT_TRUE(json["min_clearance_m"].is_null());
  EXPECT_NEAR(json["timings"]["detect"]["mean_ms"].get<double>(), 2.0, 1e-12);
  EXPECT_EQ(json["replans"]["solved"], 0);
}

}  // namespace
}  // namespace understory
