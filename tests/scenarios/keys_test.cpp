#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/config/keys.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// `understory keys`: complete, current, and true of what --set takes.
namespace {

using understory::Key;
using understory::support::content_of;
using understory::support::Outcome;
using understory::support::TemporaryFolder;
using understory::support::understory;
using Json = nlohmann::json;

TEST(Keys, ACommentBesideAFieldIsItsMeaningWithUnitAndSource) {
  const Key speed = understory::key_of_field("AirspeedConfig", "usable_mps");
  EXPECT_EQ(speed.unit, "m/s");
  EXPECT_EQ(speed.meaning,
            "pitot readings below this airspeed are ignored as inaccurate, unless the estimated "
            "airspeed exceeds 1.5 times this");  // "m/s, 0..20: " is for the header
  const Key several_lines = understory::key_of_field("FilterConfig", "rate_walk_rthz");
  EXPECT_EQ(several_lines.unit, "rad/s^2/sqrt(Hz)");
  EXPECT_NE(several_lines.meaning.find("50 rad/s^2 for 0.1 s."), std::string::npos) << several_lines.meaning;
  EXPECT_EQ(understory::key_of_field("WindConfig", "shelter_factor").source,
            "Albini & Baughman 1979; Andrews 2012");
  EXPECT_EQ(understory::key_of_field("GroundVelocityConfig", "sigma_mps").source, "docs/sources.md [15]");
  EXPECT_EQ(understory::key_of_field("WindConfig", "none").meaning, "");
}

#ifdef UNDERSTORY_HAS_SIM

TEST(Keys, EveryKeyHasAMeaningAndADefaultWithinItsRange) {
  const Json keys = Json::parse(understory("keys --json").text);
  EXPECT_GT(keys.size(), 300u);
  for (const Json& key : keys) {
    EXPECT_NE(key["meaning"], "") << key;
    const std::string range = key["range"];
    if (const auto dots = range.find(" .. "); key["default"].is_number() && dots != std::string::npos) {
      EXPECT_GE(key["default"].get<double>(), std::stod(range.substr(0, dots))) << key;
      EXPECT_LE(key["default"].get<double>(), std::stod(range.substr(dots + 4))) << key;
    }
  }
}

TEST(Keys, ThePageIsCurrentAndNoColumnIsWithoutAMeaning) {
  const Outcome page = understory("keys --markdown");
  EXPECT_EQ(page.status, 0);
  EXPECT_EQ(page.text, content_of(UNDERSTORY_SOURCE_DIR "/docs/keys.md"))
      << "mend it: understory keys --markdown > docs/keys.md";
  const std::string columns = page.text.substr(page.text.find("## Columns"));
  EXPECT_EQ(columns.find("|  |\n"), std::string::npos) << columns;
}

/// A scenario's values, each given with --set over the defaults, are that scenario.
TEST(Keys, NamesAndValuesAreThoseOfSet) {
  const TemporaryFolder folder;
  std::string settings;
  for (const Json& key : Json::parse(understory("keys goalposts --json").text)) {
    const std::string value =
        key["value"].is_string() ? key["value"].get<std::string>() : key["value"].dump();
    const auto name = key["key"].get<std::string>();
    if (name.find("[]") != std::string::npos) continue;  // entries of lists that are empty
    settings += " --set '" + name + "=" + (value.empty() ? "\"\"" : value) + "'";
  }
  const std::string plain = folder.write("plain.yaml", "name: x\n").string();
  const std::string run = " --set time_limit_s=0.5 --quiet --out " + folder.path().string();
  EXPECT_EQ(understory("fly goalposts" + run + "/a").status, 1);
  EXPECT_EQ(understory("fly " + plain + settings + run + "/b").status, 1);
  EXPECT_EQ(content_of(folder.path() / "a/scenario.yaml"), content_of(folder.path() / "b/scenario.yaml"));
}

#endif

}  // namespace
