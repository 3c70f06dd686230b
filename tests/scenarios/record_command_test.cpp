#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// `understory record` as people meet it.
namespace understory::support {
namespace {

namespace fs = std::filesystem;
using RecordCommand = FolderTest;

const std::string flight = " forest --seed 1007 --set time_limit_s=0.9 --set cameras.rate_hz=60";

TEST_F(RecordCommand, RecordingChangesNoFlight) {
  const std::string flown = path("flown"), kept = path("kept");
  EXPECT_EQ(understory("fly --quiet" + flight + " --out " + flown).status, 1);  // time is over
  const auto outcome = understory("record" + flight + " --out " + kept);
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  const auto digest = [](const std::string& run) {
    return nlohmann::json::parse(content_of(fs::path(run) / "result.json")).at("digest");
  };
  EXPECT_EQ(digest(flown), digest(kept));
  EXPECT_EQ(content_of(fs::path(flown) / "scenario.yaml"), content_of(fs::path(kept) / "scenario.yaml"));
  for (const char* sensor :
       {"cam0", "cam1", "imu0", "state_groundtruth_estimate0", "estimate0", "depth0", "objects0"})
    for (const char* file : {"sensor.yaml", "data.csv"})
      EXPECT_TRUE(fs::is_regular_file(fs::path(kept) / "mav0" / sensor / file)) << sensor << ", " << file;
  expect_refusal("record" + flight + " --out " + kept, "holds results already: --force");
}

TEST_F(RecordCommand, TwoRecordingsOfAWoodHoldTheSameBytes) {
  const fs::path one = folder.path() / "one", other = folder.path() / "other";
  for (const fs::path& kept : {one, other}) {
    const auto outcome = understory(
        "record woods --seed 1007 --path scenarios/library/paths/level.tum --set "
        "cameras.rate_hz=2 --out " +
        kept.string());
    EXPECT_EQ(outcome.status, 0) << outcome.text;
  }
  int files = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(one / "mav0")) {
    if (!entry.is_regular_file()) continue;
    EXPECT_TRUE(content_of(entry.path()) == content_of(other / fs::relative(entry.path(), one))) << entry;
    ++files;
  }
  EXPECT_GT(files, 40);
  const std::string objects = content_of(one / "mav0" / "objects0" / "objects.csv");
  for (const char* kind : {"trunk", "branch", "foliage", "undergrowth"}) expect_part(objects, kind);
}

TEST_F(RecordCommand, WrongArgumentsAreBadInput) {
  const std::string out = " --out " + path("out");
  expect_refusal("record forest", "--out");
  expect_refusal("record nowhere" + out, "nowhere");
  expect_refusal("record forest --walk=0" + out, "--walk");
  expect_refusal("record forest --walk --height 20" + out, "--height");
  expect_refusal("record forest --height 2" + out, "--height requires --walk");
  expect_refusal("record forest --walk --set forest.square_metres_per_tree=4" + out, "straight lane");
  expect_refusal("record forest --path nowhere.tum" + out, "nowhere.tum: cannot read this file");
  expect_refusal("record forest --path scenarios/library/paths/level.tum --walk" + out,
                 "--path and --walk exclude");
  expect_refusal("record forest --path scenarios/library/paths/level.tum --height 2" + out,
                 "--height requires --walk");
  expect_refusal("record forest --set rig=none" + out, "rig: must be a name");
  expect_refusal("record forest --out /proc/none", "/proc/none");
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
}

}  // namespace
}  // namespace understory::support
