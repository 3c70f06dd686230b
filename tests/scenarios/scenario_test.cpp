#include <gtest/gtest.h>

#include <algorithm>

#include "estimation/filter_config.hpp"
#include "perception/io/calibration/calibration_file.hpp"
#include "scenarios/config/config_tree.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "scenarios/scenario/scenario_rig.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/text.hpp"

namespace understory {
namespace {

namespace fs = std::filesystem;
using namespace support;
using ScenarioRig = FolderTest;

const fs::path library = fs::path(UNDERSTORY_SOURCE_DIR) / "scenarios/library";
const fs::path models = fs::path(UNDERSTORY_SOURCE_DIR) / "models";

TEST(Scenario, EveryLibraryFileLoadsAndSurvivesARoundTrip) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(library)) {
    if (entry.is_directory()) continue;
    const Scenario scenario = load_scenario(entry.path());
    const std::string text = scenario_to_text(scenario);
    EXPECT_EQ(scenario_to_text(scenario_from_text(text, "again.yaml")), text) << entry.path();
    EXPECT_EQ(scenario.name, entry.path().stem().string());
    ++count;
  }
  EXPECT_GE(count, 5);
}

TEST(Scenario, TheLibraryIsWhatTheMissionSays) {
  const Scenario forest = load_scenario(library / "forest.yaml");
  EXPECT_EQ(forest.forest.square_metres_per_tree, 49);
  EXPECT_EQ(forest.rig, "long");
  EXPECT_EQ(forest.goal_x_m(), 75);
  EXPECT_EQ(forest.forest.half_width_m, 25);
  EXPECT_EQ(forest.band.minimum_altitude_m, 1);
  EXPECT_EQ(forest.band.maximum_altitude_m, 6);
  EXPECT_EQ(forest.autopilot.replan_rate_hz, 600);
  EXPECT_EQ(Scenario().autopilot.replan_rate_hz, 600);
  EXPECT_EQ(load_scenario(library / "forest.yaml", {"autopilot.preset=thorough"}).autopilot.replan_rate_hz,
            120);
  EXPECT_EQ(forest.autopilot.planner.search.iterations, 80);
  EXPECT_EQ(load_scenario(library / "forest.yaml", {"autopilot.replan_rate_hz=120"}).autopilot.replan_rate_hz,
            120);
  EXPECT_EQ(load_scenario(library / "dense.yaml").forest.square_metres_per_tree, 25);
  EXPECT_EQ(load_scenario(library / "paper.yaml").rig, "paper");
  EXPECT_EQ(load_scenario(library / "clear.yaml").course, "clear");
  EXPECT_EQ(load_scenario(library / "goalposts.yaml").course, "goalposts");
  EXPECT_EQ(load_scenario(library / "windy.yaml").wind_world_mps, Eigen::Vector3d(0, 3, 0));
}

/// A key in which a scenario of the library differs from forest.yaml, and what its comments say of it.
struct Difference {
  const char *scenario, *key, *comment;
};

const std::vector<Difference> known_differences{
    {"dense", "forest.square_metres_per_tree", "one tree per 25 m^2"},
    {"dense", "perception.depths_m", "five neighbouring disparities"},
    {"dense", "autopilot.map.voxel_m", "fewer points than one depth"},
    {"agile", "forest.square_metres_per_tree", "one tree per 25 m^2"},
    {"agile", "forest.radius_", "0.6 m thick"},
    {"agile", "forest.length_m", "40 m"},
    {"paper", "rig", "with the rig of Barry & Tedrake"},
    {"paper", "perception.pushbroom.", "with the rig of Barry & Tedrake"},  // the numbers tuned for it
    {"paper", "band.cruise_altitude_m", "a hard dodge sinks 1.5 m"},
    {"paper", "autopilot.flight_model.cruise_speed_mps", "more roll authority"},
    {"paper", "perception.depths_m", "single depth"},
    {"paper_depths", "rig", "the rig of Barry & Tedrake"},
    {"paper_depths", "perception.pushbroom.", "the rig of Barry & Tedrake"},
    {"paper_depths", "perception.depths_m", "depths"},
    {"paper_depths", "band.cruise_altitude_m", "All else is as in"},
    {"paper_depths", "autopilot.flight_model.cruise_speed_mps", "All else is as in"},
    {"paper_depths", "autopilot.map.voxel_m", "as many points as two depths"},
    {"woods", "world.scenery", "as woods"},
    {"woods", "cameras.", "seen through a lens"},
    {"woods", "perception.preset", "parameters for woods"},
    {"woods", "perception.pushbroom.", "parameters for woods"},
    {"woods", "perception.depths_m", "five neighbouring depths"},
    {"woods", "autopilot.map.voxel_m", "voxels of dense.yaml"},
    {"woods_dense", "forest.square_metres_per_tree", "one tree per 25 m^2"},
    {"woods_dense", "world.scenery", "woods of woods.yaml"},
    {"woods_dense", "cameras.", "woods of woods.yaml"},
    {"woods_dense", "perception.", "woods of woods.yaml"},
    {"woods_dense", "autopilot.map.voxel_m", "woods of woods.yaml"},
    {"woods_low", "world.", "begin at a height of 4 to 6 m"},
    {"woods_low", "cameras.", "woods of woods.yaml"},
    {"woods_low", "perception.", "woods of woods.yaml"},
    {"woods_low", "autopilot.map.voxel_m", "woods of woods.yaml"},
    {"woods_dusk", "world.", "at dusk"},
    {"woods_dusk", "cameras.", "a quarter of the light"},
    {"woods_dusk", "perception.", "woods of woods.yaml"},
    {"woods_dusk", "autopilot.map.voxel_m", "woods of woods.yaml"},
    {"inventory", "forest.trees_file", "measured forest"},
    {"inventory_5cm", "forest.trees_file", "measured forest"},
    {"inventory_5cm", "forest.thinnest_stem_m", "at least 5 cm"},
    {"inventory_5cm", "perception.", "thin stems give few detections"},
    {"inventory_3cm", "perception.", "thin stems give few detections"},
    {"inventory_3cm", "forest.trees_file", "measured forest"},
    {"inventory_3cm", "forest.thinnest_stem_m", "at least 3 cm"},
    {"windy", "wind_world_mps", "3 m/s across the flight"},
    {"windy", "wind.turbulence_wind20_mps", "turbulence"},
    {"windy", "perception.depths_m", "a second depth"},
    {"windy", "estimation.", "the filter estimates wind and gusts"},
    {"pitot_blocked", "faults", "the pitot tube is blocked"},
    {"rough_sensors", "band.cruise_altitude_m", "the middle of its band"},
    {"rough_sensors", "sensors.", "every error is three times"},
    {"rough_sensors", "estimation.filter.", "filter knows"},
};

TEST(Scenario, TwoOfTheLibraryDifferOnlyInWhatTheirCommentsSay) {
  const FlatKeys forest = flat_keys(scenario_to_text(load_scenario(library / "forest.yaml")), "forest");
  int compared = 0;
  for (const auto& entry : fs::directory_iterator(library)) {
    if (entry.is_directory()) continue;
    const std::string name = entry.path().stem().string(), text = content_of(entry.path());
    if (load_scenario(entry.path()).course != "forest") continue;
    ++compared;
    for (const auto& [key, value] : flat_keys(scenario_to_text(load_scenario(entry.path())), name)) {
      if (key == "name" || key.starts_with("files") || value == value_in(forest, key)) continue;
      const auto known = std::ranges::find_if(known_differences, [&, &k = key](const Difference& one) {
        return name == one.scenario && k.starts_with(one.key);
      });
      ASSERT_NE(known, known_differences.end()) << name << ".yaml differs in " << key << ": " << value;
      EXPECT_NE(text.find(known->comment), std::string::npos) << name << ".yaml says nothing of " << key;
    }
    // How plans are made and blocks are matched is everybody's default.
    EXPECT_EQ(text.find("preset: economical"), std::string::npos) << name;
    EXPECT_EQ(text.find("preset: thorough"), std::string::npos) << name;
  }
  EXPECT_GE(compared, 6);
}

TEST(Scenario, TheFilterStartsAsTheAircraftStandsAndKnowsItsSensors) {
  const Scenario nominal = scenario_from_text("name: a\n", "a.yaml");
  EXPECT_NEAR(nominal.estimation.filter().start.pitch_rad, 0.398, 0.002);  // slope and angle of attack
  const FilterConfig tuned;
  EXPECT_EQ(nominal.estimation.filter().altitude.noise_m, tuned.altitude.noise_m);
  EXPECT_EQ(nominal.estimation.filter().gyro_noise_radps_rthz, tuned.gyro_noise_radps_rthz);
  EXPECT_EQ(nominal.estimation.filter().altitude.wash_sigma_m_per_n, 0);
  const Scenario rough = scenario_from_text("sensors: {grade: rough}\n", "a.yaml");
  EXPECT_NEAR(rough.estimation.filter().altitude.noise_m, 3 * tuned.altitude.noise_m, 1e-12);
  EXPECT_NEAR(rough.estimation.filter().start.gyro_bias_sigma_radps, 3 * tuned.start.gyro_bias_sigma_radps,
              1e-12);
  EXPECT_NEAR(rough.estimation.filter().altitude.wash_sigma_m_per_n, 0.39, 1e-12);
  EXPECT_GT(rough.estimation.filter().rest.rate_tolerance_radps, tuned.rest.rate_tolerance_radps);
  // A scenario that says otherwise wins; the original's filter knew nothing of its sensors.
  EXPECT_EQ(scenario_from_text("{sensors: {grade: rough}, estimation: {filter: {altitude: {noise_m: 0.7}}}}",
                               "a.yaml")
                .estimation.filter()
                .altitude.noise_m,
            0.7);
  EXPECT_EQ(scenario_from_text("{sensors: {grade: rough}, estimation: {preset: original}}", "a.yaml")
                .estimation.filter()
                .altitude.sigma_m,
            original_filter().altitude.sigma_m);
}

TEST(Scenario, OldNamesAreRefusedWithTheNewOnes) {
  const auto refused = [](const char* text, const char* part) {
    expect_part(refusal_of([&] { scenario_from_text(text, "a.yaml"); }), part);
  };
  refused("perception: {rule: tuned}", "did you mean preset?");
  refused("perception: {preset: paper}", "did you mean original?");
  refused("sensors: {grade: plain}", "did you mean nominal?");
  refused("fence: {gate_m: 3}", "did you mean opening_m?");
  refused("band: {least_altitude_m: 1}", "did you mean minimum_altitude_m?");
}

TEST(Scenario, EveryDefaultIsWritten) {
  const Scenario scenario;
  const std::string text = scenario_to_text(scenario);
  for (const char* key : {"square_metres_per_tree", "latency_s", "lens_cap", "mass_kg", "maximum_altitude_m",
                          "invisible", "detector", "source"}) {
    expect_part(text, std::string(key) + ": ");
  }
  expect_no_part(text, "obstacles_visible");  // forest.invisible stands for it
}

TEST(Scenario, FilterAndPlannerTakeTheWingFromTheAirframe) {
  const Scenario heavy =
      scenario_from_text("airframe: {mass_kg: 0.8, wing_area_m2: 0.2, winglet_area_m2: 0.03}\n", "a.yaml",
                         {"airframe.air_density_kgpm3=1.1", "airframe.gravity_mps2=9.7"});
  const FilterConfig& filter = heavy.estimation.filter();
  EXPECT_EQ(filter.gravity_mps2, 9.7);
  EXPECT_EQ(filter.sideslip.mass_kg, 0.8);
  EXPECT_EQ(filter.sideslip.air_density_kgpm3, 1.1);
  EXPECT_EQ(filter.sideslip.winglets_area_m2, 0.06);  // of both
  EXPECT_EQ(filter.angle_of_attack.mass_kg, 0.8);
  EXPECT_EQ(filter.angle_of_attack.air_density_kgpm3, 1.1);
  EXPECT_EQ(filter.angle_of_attack.wing_area_m2, 0.2);
  expect_part(support::refusal_of([] { scenario_from_text("airframe:\n  span_m: 1.5\n", "a.yaml"); }),
              "a.yaml:2: airframe.span_m: must be 0.8636: the body that collides has this span");

  const Scenario doubting =
      scenario_from_text("airframe: {mass_kg: 0.8}\n", "a.yaml", {"estimation.filter.sideslip.mass_kg=0.5"});
  EXPECT_EQ(doubting.estimation.filter().sideslip.mass_kg, 0.5);  // written, so it wins
  EXPECT_EQ(doubting.estimation.filter().angle_of_attack.mass_kg, 0.8);

  // By default nothing is derived that the structs do not say themselves.
  const FilterConfig plain = scenario_from_text("name: a\n", "a.yaml").estimation.filter();
  EXPECT_EQ(plain.sideslip.winglets_area_m2, SideslipConfig{}.winglets_area_m2);
  EXPECT_EQ(plain.sideslip.winglets_body_m, SideslipConfig{}.winglets_body_m);
  EXPECT_EQ(plain.angle_of_attack.pitch_damping_nmspr, AngleOfAttackConfig{}.pitch_damping_nmspr);
}

TEST(Scenario, SettingsComeAfterTheFile) {
  const Scenario scenario = scenario_from_text("seed: 5\nforest: {length_m: 30}\n", "a.yaml",
                                               {"forest.length_m=40", "sensors.seed=9"});
  EXPECT_EQ(scenario.forest.length_m, 40);
  EXPECT_EQ(scenario.seed, 5u);
  EXPECT_EQ(scenario.sensor_seed(), 9u);
  EXPECT_EQ(scenario_from_text("seed: 5\n", "a.yaml").sensor_seed(), 5u);
}

TEST(Scenario, RefusesContradictions) {
  EXPECT_THROW(scenario_from_text("forest: {radius_min_m: 0.3}\n", "a.yaml"), ScenarioError);
  EXPECT_THROW(scenario_from_text("actuators: {pitch_speed_mps: 10}\n", "a.yaml"), ScenarioError);
  for (const int good : {1, 40, 120, 200, 1200})  // rates fall on physics steps
    EXPECT_EQ(scenario_from_text("seed: 1\n", "a.yaml", {"cameras.rate_hz=" + std::to_string(good)})
                  .cameras.rate_hz,
              good);
  for (const int bad : {-200, 0, 7, 110, 2400})
    EXPECT_THROW(scenario_from_text("seed: 1\n", "a.yaml", {"cameras.rate_hz=" + std::to_string(bad)}),
                 ScenarioError);
  EXPECT_THROW(scenario_from_text("world: {obstacles_visible: false}\n", "a.yaml"), ScenarioError);
}

TEST(Scenario, FullStereosNumbersAreRefusedInOneLineWhereOpenCvWouldThrow) {
  const auto refusal = [](const std::string& text) {
    return refusal_of<ScenarioError>([&] { scenario_from_text(text, "a.yaml"); });
  };
  EXPECT_EQ(refusal("band: {least_altitude_m: 1}"),  // as keys were called in 0.1
            "a.yaml:1: band.least_altitude_m: unknown key (did you mean minimum_altitude_m?)");
  EXPECT_EQ(refusal("perception:\n  stereo_bm: {window_px: 6}\n"),
            "a.yaml:2: perception.stereo_bm.window_px: must be an odd number");
  EXPECT_EQ(refusal("perception:\n  stereo_sgbm: {disparities: 100}\n"),
            "a.yaml:2: perception.stereo_sgbm.disparities: must be a multiple of 16");
  EXPECT_EQ(refusal("perception:\n  stereo_sgbm: {smoothness_1: 40}\n"),
            "a.yaml:2: perception.stereo_sgbm.smoothness_1: must be less than smoothness_2");
  EXPECT_EQ(refusal("perception: {full_stereo: {minimum_depth_m: 20}}"),
            "a.yaml:1: perception.full_stereo.minimum_depth_m: 20 must be less than maximum_depth_m, 15");
  EXPECT_EQ(refusal("perception: {detector: stereo}"),
            "a.yaml:1: perception.detector: expected pushbroom | stereo_bm | stereo_sgbm | true_depth | "
            "synthetic | none, "
            "got stereo (did you mean stereo_bm?)");
  EXPECT_EQ(refusal("perception: {compute: {factor: -1}}"),
            "a.yaml:1: perception.compute.factor: expected a number from 0.001 to 1000, got -1");
}

TEST(Scenario, AGradeIsWhereTheKeysBesideItStart) {
  const Scenario rough = scenario_from_text("sensors: {grade: rough, imu: {gyro_scale: 0.002}}\n", "a.yaml");
  EXPECT_EQ(rough.sensors.imu.gyro_scale, 0.002);
  EXPECT_EQ(rough.sensors.imu.accelerometer_scale,
            sensors_of_grade(SensorGrade::rough).imu.accelerometer_scale);
  const Scenario plain = scenario_from_text("seed: 5\n", "a.yaml");
  EXPECT_EQ(plain.sensors.imu.gyro_scale, 0);
  EXPECT_EQ(scenario_from_text("seed: 5\n", "a.yaml", {"sensors.grade=ideal"}).sensors.imu.gyro_noise_radps,
            0);
}

TEST(Scenario, ARuleIsTheRigsOwnUnderTheKeysBesideIt) {
  const auto rule = [](const char* text) {
    return scenario_from_text(text, "rule.yaml").perception.pushbroom();
  };
  EXPECT_EQ(rule("name: a").minimum_edge_sum, tuned_pushbroom("long").minimum_edge_sum);
  EXPECT_EQ(rule("perception: {preset: robust}").minimum_edge_sum, robust_pushbroom().minimum_edge_sum);
  EXPECT_EQ(rule("perception: {preset: original}").minimum_edge_sum, original_pushbroom().minimum_edge_sum);
  const PushbroomConfig tuned =
      rule("{rig: paper, perception: {preset: tuned, pushbroom: {score_limit: 0.2}}}");
  EXPECT_EQ(tuned.minimum_edge_sum, tuned_pushbroom("paper").minimum_edge_sum);
  EXPECT_EQ(tuned.score_limit, 0.2);
  EXPECT_NE(tuned.minimum_edge_sum, rule("{rig: long, perception: {preset: tuned}}").minimum_edge_sum);
  EXPECT_EQ(tuned_pushbroom("somebody's").minimum_edge_sum, robust_pushbroom().minimum_edge_sum);
}

TEST(Scenario, FaultsAreReadWrittenAndChecked) {
  const Scenario scenario = scenario_from_text(
      "faults:\n  - {sensor: pitot, kind: block, at_s: 2}\n  - {sensor: gyro, kind: bias, at_s: 1, "
      "duration_s: 0.5, value: 0.1}\n",
      "a.yaml");
  ASSERT_EQ(scenario.faults.size(), 2u);
  EXPECT_EQ(scenario.faults[1].sensor, FaultySensor::gyro);
  EXPECT_EQ(scenario.faults[1].value, 0.1);
  const Scenario again = scenario_from_text(scenario_to_text(scenario), "again.yaml");
  ASSERT_EQ(again.faults.size(), 2u);
  EXPECT_EQ(again.faults[1].duration_s, 0.5);
  EXPECT_TRUE(scenario_from_text(scenario_to_text(scenario), "again.yaml", {"faults=[]"}).faults.empty());
  const auto refused = [] {
    scenario_from_text("seed: 1\nfaults:\n  - sensor: barometer\n    kind: block\n", "a.yaml");
  };
  EXPECT_EQ(refusal_of<ScenarioError>(refused),
            "a.yaml:4: faults[0].kind: must be, for this sensor, freeze | dropout | bias | saturate");
}

TEST(Scenario, ALongCourseHasTimeRoomGpsAndAnAltitudeOfItsOwn) {
  const Scenario usual = scenario_from_text("forest: {length_m: 85}\n", "a.yaml"),
                 longer = scenario_from_text("forest: {length_m: 985}\n", "a.yaml"),
                 said = scenario_from_text(
                     "time_limit_s: 7\nforest: {length_m: 985, half_width_m: 20}\nsensors: {gps: "
                     "{enabled: false}}\nband: {cruise_altitude_m: 5}\n",
                     "a.yaml");
  EXPECT_FALSE(usual.is_long());
  EXPECT_EQ(usual.time_limit_s, 30);
  EXPECT_EQ(usual.mission().half_width_m, 25);
  EXPECT_EQ(usual.mission().cruise_altitude_m, 4.5);
  EXPECT_FALSE(usual.sensors.gps.enabled);
  EXPECT_TRUE(longer.is_long());
  EXPECT_EQ(longer.time_limit_s, 167);  // 2 * 1000 m at 12 m/s
  EXPECT_EQ(longer.forest.half_width_m, 36);
  EXPECT_NEAR(longer.mission().half_width_m, 25.2, 1e-9);
  EXPECT_EQ(longer.mission().cruise_altitude_m, 4);
  EXPECT_TRUE(longer.sensors.gps.enabled);
  EXPECT_FALSE(longer.estimation.filter().gps.enabled);
  EXPECT_EQ(said.time_limit_s, 7);
  EXPECT_EQ(said.forest.half_width_m, 20);
  EXPECT_EQ(said.mission().cruise_altitude_m, 5);
  EXPECT_FALSE(said.sensors.gps.enabled);
}

TEST(Scenario, TheAircraftThatFliesMayDifferFromTheStacks) {
  const Scenario scenario = scenario_from_text("mismatch: {mass_percent: 10}\n", "a.yaml");
  EXPECT_DOUBLE_EQ(scenario.flown_airframe().mass_kg, 1.1 * scenario.airframe.mass_kg);
  EXPECT_EQ(scenario.airframe.mass_kg, Airframe{}.mass_kg);
}

TEST(Scenario, ShelterIsWhereTheForestIs) {
  const ForestStand stand = scenario_from_text("forest: {length_m: 40}\n", "a.yaml").stand();
  EXPECT_EQ(stand.from_x_m, 15);
  EXPECT_EQ(stand.to_x_m, 55);
  EXPECT_EQ(stand.half_width_m, 25);
  EXPECT_EQ(stand.canopy_top_m, 9);
  EXPECT_EQ(scenario_from_text("course: clear\n", "a.yaml").stand().canopy_top_m, 0);
}

TEST(Scenario, ProofSwitchesReachTheWorld) {
  const Scenario scenario =
      scenario_from_text("forest: {invisible: true}\n", "a.yaml", {"forest.intangible=true"});
  EXPECT_FALSE(scenario.world_config().obstacles_visible);
  EXPECT_FALSE(scenario.world_config().obstacles_tangible);
}

CalibratedRig rig_for(const std::vector<std::string>& settings) {
  return rig_of(scenario_from_text("name: a\n", "a.yaml", settings), models);
}

std::string refusal_for(const std::vector<std::string>& settings) {
  return refusal_of<ScenarioError>([&] { rig_for(settings); });
}

TEST_F(ScenarioRig, IsRectifiedUnlessTheScenarioSaysRaw) {
  EXPECT_FALSE(rig_for({"rig=long"}).calibration.has_value());
  EXPECT_EQ(rig_for({"rig=long"}).rig.focal_px, read_rig(models / "rigs/long.yaml").focal_px);
}

TEST_F(ScenarioRig, RawCamerasStandWhereTheRigsFileMountsTheRectifiedPair) {
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

TEST_F(ScenarioRig, APathIsLookedForBesideTheFileThatGivesIt) {
  const auto own = [&](const char* name, double detection_depth_m) {
    std::string text = content_of(models / "rigs/long.yaml");
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
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  EXPECT_EQ(depth_m(load_scenario(forest, {"rig=own.yaml"})), 9);
  fs::current_path(before);

  // A run folder's scenario flies again from anywhere.
  const auto again = folder.write("runs/1/scenario.yaml", scenario_to_text(load_scenario(forest)));
  EXPECT_EQ(depth_m(load_scenario(again)), 7);

  // A plain word is a name, whatever lies beside: here a scenario.
  folder.write("forest/paper.yaml", "rig: long\n");
  EXPECT_EQ(load_scenario(folder.write("forest/named.yaml", "rig: paper\n")).rig, "paper");
}

TEST_F(ScenarioRig, SaysInOneLineWhatIsWrongWithARawRig) {
  expect_part(refusal_for({"rig=paper", "cameras.raw=true"}), "cameras.raw_unit_m");
  expect_part(refusal_for({"rig=nowhere", "cameras.raw=true"}), "rig: must be");
  const fs::path file = folder.path() / "own.yaml";
  fs::copy_file(models / "rigs/long.yaml", file);
  expect_part(refusal_for({"rig=" + file.string(), "cameras.raw=true"}), "own.xml");
  // Another rig's calibration under this rig's name.
  fs::create_directory(folder.path() / "raw");
  fs::copy_file(models / "rigs/raw/paper.xml", folder.path() / "raw/own.xml");
  const std::string other =
      refusal_for({"rig=" + file.string(), "cameras.raw=true", "cameras.raw_unit_m=0.01"});
  expect_part(other, "focal length 386.9 px");
}

}  // namespace
}  // namespace understory
