#include "scenarios/scenario/scenario_rig.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "perception/io/calibration_file.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "tests/support/temporary_folder.hpp"

namespace understory {
namespace {

const std::filesystem::path models = std::filesystem::path(UNDERSTORY_SOURCE_DIR) / "models";

CalibratedRig rig_for(const std::vector<std::string>& settings) {
  return rig_of(scenario_from_text("name: a\n", "a.yaml", settings), models);
}

std::string refusal_for(const std::vector<std::string>& settings) {
  try {
    rig_for(settings);
  } catch (const ScenarioError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "";
}

TEST(ScenarioRig, IsRectifiedUnlessTheScenarioSaysRaw) {
  EXPECT_FALSE(rig_for({"rig=long"}).calibration.has_value());
  EXPECT_EQ(rig_for({"rig=long"}).rig.focal_px, read_rig(models / "rigs/long.yaml").focal_px);
}

TEST(ScenarioRig, RawCamerasStandWhereTheRigsFileMountsTheRectifiedPair) {
  for (const auto& settings : {std::vector<std::string>{"rig=long"},
                               std::vector<std::string>{"rig=paper", "cameras.raw_unit_m=0.01"}}) {
    std::vector<std::string> with_raw = settings;
    with_raw.emplace_back("cameras.raw=true");
    const StereoRig mounted = rig_for(settings).rig;
    const CalibratedRig raw = rig_for(with_raw);
    ASSERT_TRUE(raw.calibration.has_value());
    EXPECT_TRUE(raw.rig.T_body_camera.isApprox(mounted.T_body_camera, 1e-6));
    EXPECT_NEAR(raw.rig.baseline_m, mounted.baseline_m, 1e-3);
    EXPECT_NEAR(raw.rig.infinity_disparity_px(), mounted.infinity_disparity_px(), 0.1);
    EXPECT_EQ(raw.rig.detection_depth_m, mounted.detection_depth_m);
  }
}

TEST(ScenarioRig, APathIsLookedForBesideTheFileThatGivesIt) {
  const support::TemporaryFolder folder;
  const auto own = [&](const char* name, double detection_depth_m) {
    std::string text = support::content_of(models / "rigs/long.yaml");
    const std::size_t value = text.find("detection_depth_m: ") + 19;
    text.replace(value, text.find_first_of(" \n", value) - value, std::to_string(detection_depth_m));
    folder.write(name, text);
  };
  own("forest/own.yaml", 7), own("changes/own.yaml", 8), own("own.yaml", 9);
  const auto forest = folder.write("forest/forest.yaml", "rig: own.yaml\n");
  const auto changes = folder.write("changes/changes.yaml", "rig: ./own.yaml\n");
  const auto depth_m = [](const Scenario& scenario) {
    return rig_of(scenario, models).rig.detection_depth_m;
  };
  EXPECT_EQ(depth_m(load_scenario(forest)), 7);
  EXPECT_EQ(depth_m(load_scenario(forest, {}, {changes})), 8);
  // On the command line a path is the working directory's.
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  EXPECT_EQ(depth_m(load_scenario(forest, {"rig=own.yaml"})), 9);
  std::filesystem::current_path(before);

  // A run folder's scenario flies again from anywhere.
  const auto again = folder.write("runs/1/scenario.yaml", scenario_to_text(load_scenario(forest)));
  EXPECT_EQ(depth_m(load_scenario(again)), 7);

  // A plain word is a name, whatever lies beside: here a scenario.
  folder.write("forest/paper.yaml", "rig: long\n");
  EXPECT_EQ(load_scenario(folder.write("forest/named.yaml", "rig: paper\n")).rig, "paper");
}

TEST(ScenarioRig, SaysInOneLineWhatIsWrongWithARawRig) {
  EXPECT_NE(refusal_for({"rig=paper", "cameras.raw=true"}).find("cameras.raw_unit_m"), std::string::npos);
  EXPECT_NE(refusal_for({"rig=nowhere", "cameras.raw=true"}).find("rig: expected"), std::string::npos);
  const support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "own.yaml";
  std::filesystem::copy_file(models / "rigs/long.yaml", file);
  EXPECT_NE(refusal_for({"rig=" + file.string(), "cameras.raw=true"}).find("own.xml"), std::string::npos);
  // Another rig's calibration under this rig's name.
  std::filesystem::create_directory(folder.path() / "raw");
  std::filesystem::copy_file(models / "rigs/raw/paper.xml", folder.path() / "raw/own.xml");
  const std::string other =
      refusal_for({"rig=" + file.string(), "cameras.raw=true", "cameras.raw_unit_m=0.01"});
  EXPECT_NE(other.find("focal length 386.9 px"), std::string::npos) << other;
}

}  // namespace
}  // namespace understory
