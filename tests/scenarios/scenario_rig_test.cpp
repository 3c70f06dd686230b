#include "scenarios/scenario/scenario_rig.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "perception/io/rig_file.hpp"
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
