#include <gtest/gtest.h>

#include <limits>

#include "scenarios/config/config_tree.hpp"
#include "tests/support/program.hpp"
#include "tests/validation/page.hpp"

/// What makes the pages on models, and the page on the flight model itself.
namespace understory {
namespace {

TEST(Check, HoldsOrDoesNot) {
  EXPECT_TRUE(at_most("error", 0.2, 0.2, "m").holds);
  EXPECT_FALSE(at_most("error", 0.21, 0.2, "m").holds);
  EXPECT_TRUE(at_least("speed", 8, 8, "m/s").holds);
  EXPECT_FALSE(at_least("speed", 7.9, 8, "m/s").holds);
  EXPECT_TRUE(within("thrust", 5.1, 0.1, 5.05, "N").holds);
  EXPECT_FALSE(within("thrust", 4.9, 0.1, 5.05, "N").holds);
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(at_most("error", nothing, 1, "m").holds || at_least("error", nothing, 1, "m").holds ||
               within("error", nothing, 1, 1, "m").holds);
  EXPECT_EQ(lines_of({at_most("error", 1, 2, "m"), at_most("drift", 3, 2, "m")}),
            "ok      error: 1 m, asked at most 2 m\n"
            "broken  drift: 3 m, asked at most 2 m\n");
}

Section small_section() {
  Section section{"trim"};
  section.blocks["slowest"] = "7.91";
  section.row("table", "8 | level");
  section.pictures["trim"] = "<svg/>";
  section.checks = {at_most("drift", 3, 2, "m")};
  return section;
}

const std::string page =
    "<!-- A note. -->\nLevel from <!-- trim.slowest -->9<!-- end --> m/s ([plot](x/trim.svg)).\n\n"
    "<!-- trim.table -->\n| speed | path |\n|---|---|\n| 1 | 2 |\n| 3 | 4 |\n<!-- end -->\n"
    "<!-- trim.checks -->\n| check | measured | asked | |\n|---|---|---|---|\n<!-- end -->\n";

TEST(Page, HasItsBlocksFilledAndNothingElseChanged) {
  const std::string once = filled(page, {small_section()});
  EXPECT_EQ(once,
            "<!-- A note. -->\nLevel from <!-- trim.slowest -->7.91<!-- end --> m/s ([plot](x/trim.svg)).\n\n"
            "<!-- trim.table -->\n| speed | path |\n|---|---|\n| 8 | level |\n<!-- end -->\n"
            "<!-- trim.checks -->\n| check | measured | asked | |\n|---|---|---|---|\n"
            "| drift | 3 m | at most 2 m | **broken** |\n<!-- end -->\n");
  EXPECT_EQ(filled(once, {small_section()}), once);
}

TEST(Page, ShowsAllThatIsMeasuredAndNothingMore) {
  Section section = small_section();
  section.blocks["fastest"] = "12.78";
  EXPECT_THROW(filled(page, {section}), ScenarioError);
  section = small_section();
  section.pictures["glide"] = "<svg/>";
  EXPECT_THROW(filled(page, {section}), ScenarioError);
  section = small_section();
  section.row("table", "9 | level | 4.07");
  EXPECT_THROW(filled(page, {section}), ScenarioError);
  EXPECT_THROW(filled(page, {}), ScenarioError);
}

TEST(Page, AgreesWhereOnlyRoundingDiffers) {
  EXPECT_TRUE(agree("from 7.91 to 12.78 m/s, 100 %", "from 7.92 to 12.6 m/s, 101 %"));
  EXPECT_TRUE(agree("7.202e-23", "1.1e-22"));
  EXPECT_FALSE(agree("from 7.91 m/s", "from 8.11 m/s"));
  EXPECT_FALSE(agree("within 0.194 m", "within 0.194 s"));
  EXPECT_FALSE(agree("+0.5", "-0.5"));
  EXPECT_FALSE(agree("one 1", "one 1 more"));
}

TEST(Validate, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(support::understory("soaring").status, 2);
  EXPECT_EQ(support::understory("flight_model --quietly").status, 2);
}

TEST(Validate, TheFlightModelsPageSaysWhatIsMeasuredAndItsTolerancesHold) {
  const support::ProgramRun outcome = support::understory("flight_model --check");
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("ok      replayed jog, horizontal at 1.5 s:"), std::string::npos);
  EXPECT_EQ(outcome.text.find("broken"), std::string::npos) << outcome.text;
}

}  // namespace
}  // namespace understory
