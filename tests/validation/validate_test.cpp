#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/validation/page.hpp"

/// The pages that `validate` writes, and their plots.
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
}

ValidationPage small_page() {
  ValidationPage page{"small", "A small page", "Why.", {}};
  page.sections = {{"First", "Words.", {{"plot", "A plot", "<svg/>"}}, {at_most("error", 1, 2, "m")}},
                   {"Second", "More.", {}, {at_most("drift", 3, 2, "m")}}};
  return page;
}

TEST(Page, SaysWhatWasMeasuredAskedAndBroken) {
  const ValidationPage page = small_page();
  EXPECT_EQ(broken_checks(page), 1);
  EXPECT_EQ(check_lines(page),
            "ok      error: 1 m, asked at most 2 m\n"
            "broken  drift: 3 m, asked at most 2 m\n");
  const std::string markdown = to_markdown(page);
  EXPECT_NE(markdown.find("| drift | 3 m | at most 2 m | **broken** |"), std::string::npos) << markdown;
  EXPECT_NE(markdown.find("![A plot](small/plot.svg)"), std::string::npos);
}

TEST(Page, LiesBesideItsFigures) {
  const support::TemporaryFolder folder;
  write_page(small_page(), folder.path());
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "small.md"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "small" / "plot.svg"));
}

TEST(Validate, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(support::understory("--only soaring").status, 2);
  EXPECT_EQ(support::understory("everything").status, 2);
}

/// Headings of a page: what it is about, whatever was measured.
std::vector<std::string> headings(const std::filesystem::path& page) {
  std::vector<std::string> found;
  std::ifstream stream(page);
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with("#")) found.push_back(line);
  return found;
}

TEST(Validate, WritesTheFlightModelsPageAndHoldsItsTolerances) {
  const support::TemporaryFolder folder;
  const support::Outcome outcome = support::understory("--only aircraft --out " + folder.path().string());
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("ok      replayed jog, horizontal at 1.5 s:"), std::string::npos);
  EXPECT_EQ(outcome.text.find("broken"), std::string::npos) << outcome.text;
  const std::filesystem::path committed = UNDERSTORY_SOURCE_DIR "/docs/flight_model.md";
  EXPECT_EQ(headings(folder.path() / "flight_model.md"), headings(committed))
      << "make it again: ./run validate";
  for (const auto& figure : std::filesystem::directory_iterator(folder.path() / "flight_model"))
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(UNDERSTORY_SOURCE_DIR "/docs/flight_model") /
                                        figure.path().filename()));
}

}  // namespace
}  // namespace understory
