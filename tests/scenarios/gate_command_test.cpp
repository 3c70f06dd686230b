#include <gtest/gtest.h>

#include "scenarios/campaign/flight_row.hpp"
#include "tests/support/flight_rows.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// `understory gate` as CI meets it.
namespace understory {
namespace {

using namespace support;
/// Campaigns of 120 flights, as their folders hold them.
struct GateCommand : FolderTest {
  /// The first `collisions` flights collide; `mark` makes the digests this campaign's own.
  std::string campaign(const std::string& name, std::uint64_t collisions, const std::string& mark) {
    std::vector<FlightRow> rows;
    std::string seeds;
    for (std::uint64_t seed = 0; seed < 120; ++seed) {
      rows.push_back(
          flown_row("forest", seed, seed < collisions ? "collision" : "goal", seed < collisions ? 30 : 75));
      rows.back().digest += mark;
      seeds += (seed == 0 ? "" : ", ") + std::to_string(seed);
    }
    folder.write(name + "/campaign.json",
                 R"({"format": 2, "name": "c", "commit": "abc", "renderer": "osmesa", "timeout_s": 300,
                     "conditions": [{"name": "forest", "scenario": "forest", "variant": "", "grid": {}}],
                     "seeds": [)" +
                     seeds + "]}");
    folder.write(name + "/conditions/forest.yaml", "name: forest\n");
    folder.write(name + "/flights.csv", to_csv(rows));
    return path(name);
  }
};

TEST_F(GateCommand, EndsWithItsVerdict) {
  const std::string gate = "gate --baseline " + campaign("before", 0, "");
  const auto judged = [&](const std::string& candidate, int status, const std::string& sentence,
                          const std::string& options = "") {
    const support::ProgramRun outcome = support::understory(gate + " --candidate " + candidate + options);
    EXPECT_EQ(outcome.status, status) << outcome.text;
    expect_part(outcome.text, "\n" + sentence);
  };
  judged(campaign("same", 0, ""), 0,
         "unchanged on these flights: all 120 pairs are equal to the bit. With 95 % confidence under 2.5 % "
         "of other seeds would "
         "differ");
  judged(campaign("other", 0, "x"), 0, "not worse: after 120 pairs success may have fallen by ");
  judged(campaign("three", 3, "x"), 4, "not enough flights: after 120 pairs success may have fallen by ");
  judged(path("three"), 0, "not worse: ", " --margin 0.2");
  judged(path("other"), 4, "not enough flights", " --tolerate mean_speed_mps=0");
  judged(campaign("worse", 12, "x"), 1,
         "worse: forest: success fell by 10.0 percentage points, from 120 to 108 of 120. A net loss of ",
         " --junit " + path("gate.xml") + " --json " + path("gate.json"));
  expect_part(support::content_of(folder.path() / "gate.xml"), "tests=\"121\" failures=\"13\" errors=\"0\"");
  expect_part(support::content_of(folder.path() / "gate.json"), "\"command\": \"understory fly ");
  judged(path("three"), 4, "Fly more with these commands", " --extend");
  const support::ProgramRun history = expect_success("gate --history " + path("before") + " --history " +
                                                     path("worse") + " --page " + path("h.html"));
  expect_part(history.text, "Success fell by 10.0 percentage points at worse (120 pairs)");
  const support::ProgramRun plan =
      expect_success("gate plan --baseline " + path("before") + " --candidate " + path("three"));
  expect_part(plan.text, "The outcomes of 3.3 % of the pairs differ: 3 of 120 pairs");
}

}  // namespace
}  // namespace understory
