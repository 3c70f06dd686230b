#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/config/keys.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// `understory keys`: complete, current, and true of what --set takes.
namespace understory::support {
namespace {

using understory::Key;
using Json = nlohmann::json;

TEST(Keys, ATextIsAMeaningThenItsSourceThenItsUnit) {
  const Key plain = understory::key_of("usable_mps", "readings below this airspeed are ignored");
  EXPECT_EQ(plain.unit, "m/s");  // as the name says
  EXPECT_EQ(plain.meaning, "readings below this airspeed are ignored");
  EXPECT_EQ(plain.source, "");
  const Key cited = understory::key_of("sigma_mps", "One sigma. | docs/sources.md [15]");
  EXPECT_EQ(cited.meaning, "One sigma.");
  EXPECT_EQ(cited.source, "docs/sources.md [15]");
  EXPECT_EQ(cited.unit, "m/s");
  const Key walk = understory::key_of("rate_walk_rthz", "A walk. |  | rad/s^2/sqrt(Hz)");
  EXPECT_EQ(walk.unit, "rad/s^2/sqrt(Hz)");
  EXPECT_EQ(walk.source, "");
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
  const ProgramRun page = understory("keys --markdown");
  EXPECT_EQ(page.status, 0);
  EXPECT_EQ(page.text, content_of(UNDERSTORY_SOURCE_DIR "/docs/keys.md"))
      << "mend it: understory keys --markdown > docs/keys.md";
  const std::string columns = page.text.substr(page.text.find("## Columns"));
  expect_no_part(columns, "|  |\n");
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
}  // namespace understory::support
