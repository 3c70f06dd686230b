#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "scenarios/config/keys.hpp"
#include "scenarios/flight/fly.hpp"
#include "scenarios/scenario/scenario_io.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// A part of ours is its file, a row in the table of parts and a line of the build: the example plug-ins,
/// added in this way (CMakeLists.txt here), have their keys and fly bit for bit as they do as plug-ins.
namespace understory::support {
namespace {

struct Added {
  std::string plugin, choice, own_key, wrong_value;  ///< no own key: empty
};

using BuiltIn = FolderTest;

TEST_F(BuiltIn, ARowInTheTableIsEnough) {
  for (const Added& part :
       {Added{"edge_detector", "perception.detector=edges", "perception.edges.depth_m", "1.5"},
        Added{"swerve_planner", "autopilot.method=swerve", "autopilot.swerve.hold_s", "3.5"},
        Added{"compass_source", "estimation.source=compass", "", ""},
        Added{"slalom_course", "course=slalom", "slalom.offset_m", "-1"}}) {
    SCOPED_TRACE(part.plugin);
    const Scenario scenario =
        scenario_from_text("{name: forest, seed: 1003, forest: {length_m: 20}}", "here", {part.choice});
    FlyOptions options;
    options.models_folder = UNDERSTORY_SOURCE_DIR "/models";
    const FlightResult ours = fly(scenario, options);
    const ProgramRun plugins =
        understory("fly forest --seed 1003 --set forest.length_m=20 --quiet --row " + path("row") +
                   " --plugin " PLUGINS "/" + part.plugin + ".so --set " + part.choice);
    ASSERT_LE(plugins.status, 1) << plugins.text;
    EXPECT_EQ(nlohmann::json::parse(std::ifstream(path("row"))).at("row").at("digest"), ours.digest);
    if (part.own_key.empty()) continue;
    const std::vector<Key> keys = keys_of(scenario);
    EXPECT_TRUE(std::ranges::any_of(keys, [&](const Key& key) { return key.name == part.own_key; }));
    expect_part(
        refusal_of([&] { scenario_from_text("{}", "here", {part.own_key + "=" + part.wrong_value}); }),
        part.own_key);
  }
}

}  // namespace
}  // namespace understory::support
